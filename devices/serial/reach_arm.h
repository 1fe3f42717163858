// SPDX-License-Identifier: Apache-2.0
// A Reach Alpha 5 or Bravo 7 on a serial line (RS-232 or RS-485, 115200 8N1); both speak one protocol. Facts
// from the public drivers alpha and pybravo (evan-palmer, MIT). Not verified on hardware: signs and zeros of
// the joints, the arms' own current limits (the host's limits apply), their behaviour when setpoints stop.
#pragma once

#include "devices/arm.h"
#include "devices/serial/reach_packet.h"
#include "devices/serial/serial_port.h"

#include <span>

namespace fathom {

// Arms of Reach Robotics that share one serial protocol.
enum class ReachKind { Alpha5, Bravo7 };

// Device ids of the axes, from the base to the jaws.
std::span<const uint8_t> reachDevices(ReachKind kind) noexcept;

// Control parameters.
struct ReachOptions {
    // [s] between commands; 0 = 0.02, and 0.03 for seven axes: commands and answers share an RS-485 line, and
    // take 82 % and 77 % of it
    double period = 0.0;
    double staleAfter = 0.1;        // [s] age of a position that stops the arm
    double currentStaleAfter = 0.5; // [s] the same of a motor current, which the host limits
    double lead = 0.05; // [rad] setpoints lead the measurement by at most this, which bounds the motion after
                        // a lost line
    double mostCurrent = 1.5; // [A] motor current that latches a hold after 0.1 s
};

// Axes [rad], the last one the jaws [m]. Absolute sensors: no homing. Sends positions, each at most `lead`
// ahead of the measurement; on hold, velocity 0.
class ReachArm final : public ArmDevice {
public:
    static constexpr uint8_t kVelocity = 0x02; // packet id

    ReachArm(SerialPort& port, const ReachOptions& options = {}, ReachKind kind = ReachKind::Alpha5);

    void step(double now, const ArmCommand& command) noexcept override;
    const ArmFeedback& feedback() const noexcept override { return feedback_; }
    void reset() noexcept override { feedback_.overloaded = false; }

private:
    struct Sent {
        ReachPacket packet;
        double at = -1e9; // [s]
    };
    void receive(double now) noexcept;
    void takePacket(const ReachPacket& packet, double now) noexcept;
    bool isEcho(const ReachPacket& packet, double now) noexcept;
    void watch(double now, const ArmCommand& command) noexcept;
    void sendAll(double now, const ArmCommand& command) noexcept;
    void send(const ReachPacket& packet, double now) noexcept;

    size_t jaws() const noexcept { return devices_.size() - 1; }
    double perUnit(size_t axis) const noexcept; // SI to line units

    SerialPort& port_;
    ReachOptions options_;
    std::span<const uint8_t> devices_;
    ReachReader reader_;
    ArmFeedback feedback_;
    std::array<double, kMaxArmAxes> receivedAt_{}; // [s] of each position; -1e9 = never
    std::array<double, kMaxArmAxes> currentAt_{};  // [s] of each current; -1e9 = never
    std::array<double, kMaxArmAxes> overSince_{};  // [s]; infinite = not over
    std::array<Sent, 48> sent_{};                  // ring buffer
    size_t nextSent_ = 0;
    bool echoes_ = false;       // a request was echoed
    double nextCommand_ = -1e9; // [s]
};

} // namespace fathom
