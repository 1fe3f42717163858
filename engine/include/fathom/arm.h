// SPDX-License-Identifier: Apache-2.0
/// @file
/// A real arm that follows the scene's arm: measured joints in, setpoints out.
#pragma once

#include <fathom/types.h>

#include <cstddef>
#include <memory>
#include <string>

namespace fathom::v0 {

/// Largest number of moving joints, those that follow another joint included.
inline constexpr std::size_t kMaxArmJoints = 12;

/// Positions of all joints of the scene's arm, from base to tip, and of the gripper.
struct ArmPosture {
    std::array<double, kMaxArmJoints> joints{}; ///< [rad], of sliding joints [m]; unused entries are 0
    double grasp = 0.0;                         ///< 0 open .. 1 closed; NaN in a measured posture = unknown
};

/// What the real arm measured.
struct MeasuredArm {
    ArmPosture posture{};  ///< of the joints' encoders
    Nanoseconds stamp = 0; ///< when it was measured
    bool ready = true; ///< false: it cannot follow (not homed, a motor fault, too far behind the setpoint)
};

/// What became of a report. Only Accepted reports are used.
enum class ReportStatus {
    Accepted,
    MissingStamp, ///< the stamp is zero or negative
    StampAhead,   ///< the stamp is more than 5 ms ahead of now: different clock?
    StampBack,    ///< the stamp is not later than the one before
    BadPosture    ///< a joint is not finite
};

/// The enumerator's name, for messages: "BadPosture". Any thread.
FATHOM_API const char* name(ReportStatus status) noexcept;

/// Where the real arm should be.
struct ArmSetpoint {
    ArmPosture posture{}; ///< meaningless while `hold` is true
    bool hold = true; ///< stand still: forces are off, the newest frame is too old, the tool is trapped, or
                      ///< the newest step is more than 0.1 s old
    bool forcesOff = true; ///< forces are off (Button::DeadManOpen): faults of the arm may be cleared
    Nanoseconds stamp = 0; ///< `now` of the step; 0 = no step yet
};

/// Connects the real arm. Use it from one thread, the arm thread, which may not be the haptic thread. It may
/// outlive its engine. While reports are missing for 0.1 s or say not ready, the tool stands still where the
/// arm was measured and the force is zero.
class FATHOM_API ArmPort {
public:
    /// Reports a measurement. Never allocates, locks, waits or throws.
    [[nodiscard]] ReportStatus report(const MeasuredArm& arm) noexcept;

    /// The newest setpoint. Never allocates, locks, waits or throws.
    ArmSetpoint setpoint() noexcept;

    std::size_t joints() const noexcept;            ///< moving joints of the scene's arm
    std::string jointName(std::size_t joint) const; ///< as in the URDF. @throws BadInput beyond joints()

    ArmPort(ArmPort&&) noexcept;            ///< a moved-from port may only be destroyed or assigned to
    ArmPort& operator=(ArmPort&&) noexcept; ///< likewise
    ~ArmPort();

    struct FATHOM_LOCAL Impl;
    explicit ArmPort(std::unique_ptr<Impl> impl) noexcept; ///< for the library itself

private:
    std::unique_ptr<Impl> impl_;
};

} // namespace fathom::v0
