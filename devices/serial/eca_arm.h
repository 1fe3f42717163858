// SPDX-License-Identifier: Apache-2.0
// An ECA 5E Micro on a serial line. Facts from the public driver eca_arm5emicro_driver (gitAnto, MIT): the
// arm's own position mode does not work, so that the loop is closed here on speeds; encoders are relative, so
// that joints are homed against their stops by the motor current. Unverified on hardware: signs of rotation,
// speed a count, what the current byte counts. The 5E Mini and CSIP ARM 5E speak something else or the same:
// not known.
#pragma once

#include "devices/arm.h"
#include "devices/serial/eca_frame.h"
#include "devices/serial/serial_port.h"

namespace fathom {

// How the arm is driven, and what of it no answer of the arm tells.
struct EcaOptions {
    double period = 0.05;                  // [s] between frames, as the public driver
    double staleAfter = 0.25;              // [s]
    double gain = 4.0;                     // [1/s] speed asked for a radian of error
    double fullSpeed = 0.5;                // [rad/s] of speed 4095
    double homingSpeed = 0.1;              // [rad/s]
    uint8_t stopCurrent = 120;             // of the current byte: a joint against its stop
    uint8_t mostCurrent = 200;             // of the current byte, longer than overloadTime: latched hold
    double overloadTime = 0.3;             // [s]
    uint16_t currentLimit = 4095;          // the arm's own, 0..4095
    std::array<double, kEcaJoints> stop{}; // [rad] of each joint at its clockwise stop
    int mostCounts = 8000; // that an encoder moves in a period; more is another arm or a restart: home anew
};

// Axes: shoulder, slew, elbow, wrist, gripper [rad]. Homing starts with the first command that is no hold,
// one joint after the other, and again after an encoder has jumped.
class EcaArm final : public ArmDevice {
public:
    EcaArm(SerialPort& port, const EcaOptions& options = {});

    void step(double now, const ArmCommand& command) noexcept override;
    const ArmFeedback& feedback() const noexcept override { return feedback_; }
    void reset() noexcept override { feedback_.overloaded = false; }
    size_t homedJoints() const { return homing_; }

    static double radiansPerCount(size_t joint) noexcept;

private:
    void receive(double now) noexcept;
    void heard(const std::array<EcaStatus, kEcaJoints>& status, double now) noexcept;
    void loseHome() noexcept;
    void watch(double now, const ArmCommand& command) noexcept;
    EcaDemand speedDemand(double speed) const noexcept;
    std::array<EcaDemand, kEcaJoints> demandsFor(const ArmCommand& command) noexcept;

    SerialPort& port_;
    EcaOptions options_;
    EcaReader reader_;
    ArmFeedback feedback_;
    std::array<uint16_t, kEcaJoints> encoder_{};
    std::array<int64_t, kEcaJoints> counts_{}, zero_{}; // unwrapped; counts at 0 rad
    std::array<uint8_t, kEcaJoints> current_{};
    std::array<int, kEcaJoints> pressed_{}; // frames in a row with the stop's current
    std::array<double, kEcaJoints> overSince_{};
    size_t homing_ = 0; // joints below are homed
    bool any_ = false;  // some frame came
    double heardAt_ = -1e9, nextCommand_ = -1e9;
    EcaBytes sent_{};
};

} // namespace fathom
