// SPDX-License-Identifier: Apache-2.0
// An ECA 5E Micro on a serial line. Facts from the public driver eca_arm5emicro_driver (gitAnto, MIT): the
// arm's position mode does not work, so the position loop is closed here with speed commands; encoders are
// relative, so joints are homed against their stops by motor current. Not verified on hardware: signs of
// rotation, speed per count, unit of the current byte. Whether the 5E Mini and CSIP ARM 5E use the same
// protocol is unknown.
#pragma once

#include "devices/arm.h"
#include "devices/serial/eca_frame.h"
#include "devices/serial/serial_port.h"

namespace fathom {

// Control parameters, and properties that the arm does not report.
struct EcaOptions {
    double period = 0.05;                  // [s] between frames, as in the public driver
    double staleAfter = 0.25;              // [s]
    double gain = 4.0;                     // [1/s] speed per radian of error
    double homingSpeed = 0.1;              // [rad/s]
    uint8_t stopCurrent = 120;             // current byte of a joint at its stop
    uint8_t mostCurrent = 200;             // current byte that latches a hold after 0.3 s
    uint16_t currentLimit = 4095;          // the arm's own, 0..4095
    std::array<double, kEcaJoints> stop{}; // [rad] of each joint at its clockwise stop
};

// Axes: shoulder, slew, elbow, wrist, gripper [rad]. Homing starts with the first command other than hold,
// joint by joint, and again when an encoder jumped: farther than the joint can move between two frames, or
// after a silence, in which the arm may have restarted, by more than a joint at rest.
class EcaArm final : public ArmDevice {
public:
    EcaArm(SerialPort& port, const EcaOptions& options = {});

    void step(double now, const ArmCommand& command) noexcept override;
    const ArmFeedback& feedback() const noexcept override { return feedback_; }
    void reset() noexcept override { feedback_.overloaded = false; }

    static double radiansPerCount(size_t joint) noexcept;

private:
    void receive(double now) noexcept;
    void takeStatus(const std::array<EcaStatus, kEcaJoints>& status, double now) noexcept;
    int mostMoved(size_t joint, double silence) const noexcept;
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
    std::array<int, kEcaJoints> pressed_{}; // consecutive frames with stop current
    std::array<double, kEcaJoints> overSince_{};
    size_t homing_ = 0; // joints with a lower index are homed
    bool any_ = false;  // a frame was received
    double receivedAt_ = -1e9, nextCommand_ = -1e9;
    EcaBytes sent_{};
};

} // namespace fathom
