// SPDX-License-Identifier: Apache-2.0
// Maps the raw pose of the hand to the device pose in the base frame, and the wrench back to the device's
// axes.
#pragma once

#include "engine/types/pose.h"
#include "engine/types/wrench.h"

namespace fathom {

// p_dev = offset + s R p_raw, q_dev = R q_raw C. C is a constant rotation on the right, so that when the hand
// rotates about a base axis, the device pose rotates about the same axis by the same angle. One thread;
// noexcept.
//
// Wrench on the hand: the tool's potential V(p_dev, q_dev) has the spring wrench (f, tau) = -grad V. Moving
// the hand by dx moves p_dev by s R dx, so that the hand's own gradient of V is (s R^T f, R^T tau). The port
// delivers 1/s of it,
//     f_device = R^T f,  tau_device = R^T tau / s,
// the gradient of V/s: a closed path of the hand gains no energy, the felt force equals the displayed one,
// and the stiffness at the hand is s K_t and K_r / s (coupling.h bounds both).
class HandMap {
public:
    // scale > 0 and baseRdevice of unit length: throws Error otherwise.
    HandMap(const dquat& baseRdevice, double scale);

    // Device pose of the tick. While `clutch` is true the pose stays at its last value. The first tick after
    // that recomputes offset and C, so that the pose resumes without a jump.
    Pose map(const Pose& deviceThandle, bool clutch) noexcept;

    // Recomputes offset and C so that the raw pose maps to `pose` from now on.
    void align(const Pose& deviceThandle, const Pose& pose) noexcept;

    // Moves what the raw pose maps to by `by` [m], base axes.
    void shift(const dvec3& by) noexcept {
        offset_ += by;
        held_.position += by;
    }

    // Base axes to device axes, about the handle.
    Wrench toDevice(const Wrench& base) const noexcept;
    // Orientation of the handle, and so of its motors, in the base frame. Independent of the clutch.
    dquat baseRhandle(const Pose& deviceThandle) const noexcept {
        return baseRdevice_ * deviceThandle.rotation;
    }
    double scale() const noexcept { return scale_; }
    // Torque at the hand divided by torque at the tool.
    double torqueFactor() const noexcept { return 1.0 / scale_; }

private:
    dquat baseRdevice_;
    double scale_;
    dvec3 offset_{0.0};
    dquat handleRtool_{1.0, 0.0, 0.0, 0.0}; // C: q_tool = q_handle C
    Pose held_;                             // last mapped pose
    bool clutched_ = false;
    bool started_ = false;
};

} // namespace fathom
