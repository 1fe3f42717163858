// SPDX-License-Identifier: Apache-2.0
// Public headers for the library's own sources, and conversions between public and internal types. Public
// types are in fathom::v0, internal ones of the same names in fathom.
#pragma once

#define FATHOM_BUILDING_LIBRARY
#include "engine/contact/smallest_gap.h"
#include "engine/cycle/step_record.h"
#include "engine/types/camera_info.h"
#include "engine/types/error.h"
#include "engine/types/haptic_device.h"
#include <fathom/fathom.h>

namespace fathom::front {

inline Pose internal(const v0::Pose& p) noexcept {
    const dquat q(p.rotation.w, p.rotation.x, p.rotation.y, p.rotation.z);
    return {{p.position[0], p.position[1], p.position[2]}, q};
}
inline v0::Vec3 external(const dvec3& v) noexcept {
    return {v.x, v.y, v.z};
}
inline v0::Pose external(const Pose& p) noexcept {
    return {external(p.position), {p.rotation.w, p.rotation.x, p.rotation.y, p.rotation.z}};
}
static_assert(v0::kMaxArmJoints == kMaxJoints);
static_assert(v0::kNoFixture == fathom::kNoFixture); // Touch::fixture is copied as it is
inline ArmPosture internal(const v0::ArmPosture& arm) noexcept {
    return {arm.joints, arm.grasp};
}
inline v0::ArmPosture external(const ArmPosture& arm) noexcept {
    return {arm.q, arm.grasp};
}
inline HandSample internal(const v0::Hand& hand) noexcept {
    return {internal(hand.deviceThandle), static_cast<uint32_t>(hand.buttons)};
}

inline v0::StepWarning when(bool so, v0::StepWarning warning) noexcept {
    return so ? warning : v0::StepWarning::None;
}

inline constexpr v0::Nanoseconds kMaxAhead = 5'000'000;  // [ns] by which a stamp may be ahead of now
inline constexpr v0::Nanoseconds kMaxLate = 100'000'000; // [ns] by which the time of a step may be behind it

v0::Step external(const StepRecord& record) noexcept;

// origin: of the set [m], base frame.
v0::Clearance external(const SmallestGap& gap, const Tool& tool, const dvec3& origin);

// farZ: camera.far [m], which depth in metres must reach. Throws v0::BadInput for a description that no
// camera can have.
CameraInfo internal(const v0::CameraModel& model, double farZ);

// Runs `make` and turns internal exceptions into public ones.
template <class Make>
auto translated(Make&& make) {
    try {
        return make();
    } catch (const v0::Error&) {
        throw;
    } catch (const BadInput& e) {
        throw v0::BadInput(e.what());
    } catch (const DeviceFailed& e) {
        throw v0::ComputeDeviceLost(e.what());
    } catch (const std::exception& e) {
        throw v0::Error(printable(e.what())); // a std::filesystem_error quotes a path
    }
}

} // namespace fathom::front
