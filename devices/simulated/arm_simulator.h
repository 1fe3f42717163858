// SPDX-License-Identifier: Apache-2.0
// Simulates the protocols of a Reach Alpha 5 or Bravo 7 and an ECA 5E Micro, as far as public sources
// describe them, for tests and dry runs. Pure functions of bytes and time.
#pragma once

#include "devices/serial/eca_frame.h"
#include "devices/serial/reach_arm.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace fathom {

class ArmSimulator {
public:
    virtual ~ArmSimulator() = default;
    // Takes bytes from the host; appends the arm's answers to `out`.
    virtual void receive(std::span<const uint8_t> bytes, std::vector<uint8_t>& out) = 0;
    virtual void step(double dt) = 0; // motors move for dt [s]
};

// Position setpoints are followed at `speed`, velocities kept; answers requests of position and current.
class ReachSimulator final : public ArmSimulator {
public:
    static constexpr size_t kDevices = 8;                        // by device id; 0 is none
    std::array<double, kDevices> position{};                     // [rad], jaws [mm]
    std::array<double, kDevices> current{};                      // [mA]; NaN = not reported
    std::array<double, kDevices> speed{0, 20, 1, 1, 1, 1, 1, 1}; // [rad/s], jaws [mm/s]

    explicit ReachSimulator(ReachKind kind = ReachKind::Alpha5)
        : axes_(reachDevices(kind).size()) {}

    void receive(std::span<const uint8_t> bytes, std::vector<uint8_t>& out) override;
    void step(double dt) override;

private:
    void handle(const ReachPacket& packet, std::vector<uint8_t>& out);

    size_t axes_; // devices 1 to this answer
    ReachReader reader_;
    std::array<double, kDevices> setpoint_{}, velocity_{};
    std::array<bool, kDevices> toSetpoint_{};
};

// Speeds are kept until the next frame; at a stop the current rises. Encoders start at any count and wrap.
class EcaSimulator : public ArmSimulator {
public:
    std::array<double, kEcaJoints> angle{};          // [rad]
    std::array<double, kEcaJoints> lower{}, upper{}; // [rad] stops
    std::array<uint16_t, kEcaJoints> firstCount{};   // of the encoder at angle 0
    double fullSpeed = 0.5;                          // [rad/s] of 4095
    uint8_t running = 30, pressing = 180;            // of the current byte

    void receive(std::span<const uint8_t> bytes, std::vector<uint8_t>& out) override;
    void step(double dt) override;

private:
    EcaReader reader_;
    std::array<double, kEcaJoints> rate_{}; // [rad/s]
    std::array<bool, kEcaJoints> pressed_{};
};

} // namespace fathom
