// SPDX-License-Identifier: Apache-2.0
// The bridge of a Haply Inverse3, which Haply's service drives: a hand socket to that service. When
// the engine fails in any way, the service gets zero force.
#pragma once

#include "devices/bridge/device_bridge.h"
#include "devices/haply/haply_message.h"
#include "devices/haply/web_socket.h"
#include "engine/types/clock.h"

#include <chrono>
#include <memory>

namespace fathom {

// Counters since the start.
struct HaplyFigures {
    uint64_t replies = 0;
    uint64_t late = 0;    // requests without an answer in kReplyTime
    uint64_t surplus = 0; // answers to requests before the newest, dropped
    uint64_t faults = 0;  // invalid answers
};

// One thread. When this process dies, the service ends the force itself, because each force lasts one tick
// (by its documentation; never tried on the device).
class HaplyBridge final : public DeviceBridge {
public:
    // Path of the socket, and address of the service.
    struct Options {
        std::filesystem::path endpoint;
        std::string host = "localhost";
        uint16_t port = 10001;
        std::string device; // device_id; empty = the first Inverse3
    };
    // Connects and opens the socket. Throws Error (no service, no Inverse3) or BadInput (socket).
    explicit HaplyBridge(const Options& options);
    ~HaplyBridge() override; // sends zero force

    std::string place() const { return device_ + " at " + place_; }
    const HaplyFigures& figures() const noexcept { return figures_; }

    static constexpr double kForceLimit = 5.0; // [N] of the preset "inverse3"
    static constexpr auto kReplyTime = std::chrono::milliseconds(20);
    static constexpr auto kLostAfter = std::chrono::milliseconds(500); // without an answer, then it is lost
    static constexpr auto kPeriod = std::chrono::microseconds(500);    // from request to request, at least

private:
    void open() override;
    bool isOpen() const noexcept override { return service_ != nullptr; }
    void close() noexcept override;
    void exchange() override;
    void connect();
    void ask(const dvec3& force);
    bool answered(std::chrono::microseconds most);
    void giveUpLate(Clock::time_point now);

    Options options_;
    std::unique_ptr<WebSocket> service_;
    std::string device_, place_;
    bool introduced_ = false, present_ = false;
    uint32_t awaited_ = 0; // requests without an answer so far
    Clock::time_point requestedAt_{}, receivedAt_{};
    HaplyFigures figures_;
};

} // namespace fathom
