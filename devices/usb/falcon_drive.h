// SPDX-License-Identifier: Apache-2.0
// Converts a Falcon's encoder counts to hand samples, and forces to motor commands.
#pragma once

#include "devices/usb/falcon_packet.h"
#include "engine/types/haptic_device.h"

namespace fathom {

// Keeps the last position as the initial guess of the next forward solution. noexcept, no allocation.
class FalconDrive {
public:
    // Pose with the identity as orientation (the knob only translates) and the engine's buttons: centre is
    // guidance, forward is the clutch, minus opens the dead-man switch. False when the device is not homed or
    // no pose matches the encoders; the sample then keeps the last position.
    bool place(const FalconState& state, HandSample& out) noexcept;

    // Motor commands for `force` [N] at the position of the last place(). All three are scaled together when
    // one exceeds its limit, which keeps the direction. Zero when the last place() failed or an input is not
    // finite. The mechanism renders no torque.
    std::array<int16_t, 3> motors(const dvec3& force) const noexcept;

    static constexpr double kForceLimit = 8.0;          // [N] device table of CHAI3D 3.3.0
    static constexpr double kCommandPerTorque = -10000; // [1/(N m)] of libnifalcon; no calibrated unit known

private:
    dvec3 knob_{0.0, 0.0, 0.1346};
    std::array<double, 3> angles_{};
    bool placed_ = false;
};

} // namespace fathom
