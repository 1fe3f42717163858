// SPDX-License-Identifier: Apache-2.0
// The request-response loop with a Falcon: one command out, one state in, as fast as the device answers.
#pragma once

#include "devices/usb/falcon_packet.h"
#include "devices/usb/ftdi_port.h"
#include "engine/types/clock.h"

namespace fathom {

// Counts since the link was opened.
struct FalconFigures {
    uint64_t sent = 0, replies = 0;
    uint64_t late = 0;    // requests without an answer in kReplyTime
    uint64_t surplus = 0; // answers without a request: late, or two in one transfer
    uint64_t faults = 0;  // broken packets
};

// One thread, that of the watchdog. The port must outlive it.
class FalconLink {
public:
    explicit FalconLink(FtdiPort& port)
        : port_(port) {}

    // Configures the port and waits for an answer to zero force. Without an answer it loads the firmware, if
    // given, and tries again. Throws Error with a remedy, or DeviceLost.
    void start(std::span<const uint8_t> firmware);

    // Sends the command unless the previous one is unanswered, then waits at most `most`. True when a new
    // state arrived. An unanswered request expires after kReplyTime. Throws DeviceLost, also when the device
    // accepts nothing for kLostAfter.
    bool exchange(const FalconCommand& command, std::chrono::microseconds most);

    // Sends zero force and waits briefly for the answer. Never throws: the last call before closing.
    void stop() noexcept;

    const FalconState& state() const noexcept { return stream_.newest(); }
    FalconFigures figures() const noexcept;

    static constexpr auto kReplyTime = std::chrono::milliseconds(20);
    static constexpr auto kLostAfter = std::chrono::milliseconds(500);

private:
    bool answers();

    FtdiPort& port_;
    FalconStream stream_;
    std::vector<uint8_t> received_;
    bool awaiting_ = false;
    Clock::time_point sentAt_{}, receivedAt_{};
    FalconFigures figures_;
};

} // namespace fathom
