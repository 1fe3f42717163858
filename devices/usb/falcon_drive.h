// SPDX-License-Identifier: Apache-2.0
// From a Falcon's encoders to a sample of the hand, and from a force to motor commands.
#pragma once

#include "devices/haptic_device.h"
#include "devices/usb/falcon_packet.h"

namespace fathom {

// Remembers the last place as the start of the next forward solution. noexcept, no allocation.
class FalconDrive {
public:
    // Pose with the identity as orientation (the knob only translates) and the engine's buttons: centre is
    // guidance, forward is the clutch, minus opens the dead-man switch. False when the device is not homed or
    // the encoders are no pose of the mechanism; the sample then keeps the last place.
    bool place(const FalconState& state, HandSample& out) noexcept;

    // Motor commands for `force` [N] at the place of the last place(); all three scaled down together where
    // one would exceed the motor's limit, so that the direction stays. Zero when the last place() failed or
    // anything is not finite. Torque: the mechanism has none.
    std::array<int16_t, 3> motors(const dvec3& force) const noexcept;

    static constexpr double kForceLimit = 8.0;          // [N] device table of CHAI3D 3.3.0
    static constexpr double kCommandPerTorque = -10000; // [1/(N m)] of libnifalcon; no calibrated unit known

private:
    dvec3 knob_{0.0, 0.0, 0.1346};
    std::array<double, 3> angles_{};
    bool placed_ = false;
};

} // namespace fathom
