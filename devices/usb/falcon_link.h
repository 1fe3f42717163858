// SPDX-License-Identifier: Apache-2.0
// The exchange with a Falcon: one command out, one state in, as fast as the device answers.
#pragma once

#include "devices/usb/falcon_packet.h"
#include "devices/usb/ftdi_port.h"

namespace fathom {

// Counts since the link was opened.
struct FalconFigures {
    uint64_t sent = 0, replies = 0;
    uint64_t late = 0;    // requests without an answer in kReplyTime
    uint64_t surplus = 0; // answers beyond one a request: late ones, or two in one transfer
    uint64_t faults = 0;  // broken packets
};

// One thread, the guardian's. The port must outlive it.
class FalconLink {
public:
    explicit FalconLink(FtdiPort& port)
        : port_(port) {}

    // Sets the line and waits for an answer with zero force; without one loads the firmware, if there is any,
    // and tries again. Throws Error that says what to do, DeviceLost.
    void start(std::span<const uint8_t> firmware);

    // Sends the command unless the answer to the one before is still awaited; then waits at most `most`. True
    // when a new state came. A request that nobody answers is given up after kReplyTime. Throws DeviceLost,
    // also when the device takes nothing for kDeaf.
    bool exchange(const FalconCommand& command, std::chrono::microseconds most);

    // Zero force, confirmed by an answer if one comes in time. Never throws: the last thing before closing.
    void stop() noexcept;

    const FalconState& state() const noexcept { return stream_.newest(); }
    FalconFigures figures() const noexcept;

    static constexpr auto kReplyTime = std::chrono::milliseconds(20);
    static constexpr auto kDeaf = std::chrono::milliseconds(500);

private:
    using Clock = std::chrono::steady_clock;
    bool answers();

    FtdiPort& port_;
    FalconStream stream_;
    std::vector<uint8_t> received_;
    bool awaiting_ = false;
    Clock::time_point sentAt_{}, heardAt_{};
    FalconFigures figures_;
};

} // namespace fathom
