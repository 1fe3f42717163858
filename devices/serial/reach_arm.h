// SPDX-License-Identifier: Apache-2.0
// A Reach Alpha 5 on a serial line (RS-232 or RS-485, 115200 8N1). Facts from the public driver alpha
// (evan-palmer, MIT). Not verified on hardware: signs and zeros of its joints, its own current limits (the
// host's limits apply), its behaviour when setpoints stop.
#pragma once

#include "devices/arm.h"
#include "devices/serial/reach_packet.h"
#include "devices/serial/serial_port.h"

#include <vector>

namespace fathom {

// Control parameters.
struct ReachOptions {
    double period = 0.02;    // [s] between commands
    double staleAfter = 0.1; // [s] age of feedback that stops the arm
    double lead = 0.05; // [rad] setpoints lead the measurement by at most this, which bounds the motion after
                        // a lost line
    double jawLead = 0.005;    // [m] the same for the jaws
    double mostCurrent = 1.5;  // [A] motor current that latches a hold after overloadTime
    double overloadTime = 0.1; // [s]
    double echoTime =
        0.05; // [s] window in which, on a line that echoes, a packet equal to a sent one is its echo
};

// Axes: base, shoulder, elbow, wrist [rad], jaws [m]. Absolute sensors: no homing. Sends positions, each at
// most `lead` ahead of the measurement; on hold, velocity 0.
class ReachArm final : public ArmDevice {
public:
    static constexpr size_t kAxes = 5;
    static constexpr std::array<uint8_t, kAxes> kDevice{5, 4, 3, 2, 1}; // id of each axis
    static constexpr uint8_t kVelocity = 0x02;                          // packet id

    ReachArm(SerialPort& port, const ReachOptions& options = {});

    void step(double now, const ArmCommand& command) noexcept override;
    const ArmFeedback& feedback() const noexcept override { return feedback_; }
    void reset() noexcept override { feedback_.overloaded = false; }

private:
    struct Sent {
        ReachPacket packet;
        double at = -1e9; // [s]
    };
    void receive(double now) noexcept;
    void heard(const ReachPacket& packet, double now) noexcept;
    bool isEcho(const ReachPacket& packet, double now) noexcept;
    void watch(double now, const ArmCommand& command) noexcept;
    void sendAll(double now, const ArmCommand& command) noexcept;
    void send(const ReachPacket& packet, double now) noexcept;

    SerialPort& port_;
    ReachOptions options_;
    ReachReader reader_;
    ArmFeedback feedback_;
    std::array<double, kAxes> heardAt_{};   // [s] of each position; -1e9 = never
    std::array<double, kAxes> overSince_{}; // [s]; infinite = not over
    std::array<Sent, 32> sent_{};           // ring buffer
    size_t nextSent_ = 0;
    bool echoes_ = false;       // a request was echoed
    double nextCommand_ = -1e9; // [s]
};

} // namespace fathom
