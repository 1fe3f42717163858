// SPDX-License-Identifier: Apache-2.0
#include "apps/binding/arm_axes.h"

#include "engine/types/error.h"
#include "engine/types/joined.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

namespace fathom {

namespace {

using Driver = SceneArm::Driver;

constexpr double kSlidingLag = 0.05; // [m]
// In the drivers' order; the last axis drives the jaws.
constexpr std::array<const char*, 5> kReachAxes{"base", "shoulder", "elbow", "wrist", "jaws"};
constexpr std::array<const char*, 7> kBravoAxes{"axis_g", "axis_f", "axis_e", "axis_d",
                                                "axis_c", "axis_b", "jaws"};
constexpr std::array<const char*, 5> kEcaAxes{"shoulder", "slew", "elbow", "wrist", "gripper"};

std::span<const char* const> namesOf(Driver::Protocol protocol) noexcept {
    using Names = std::span<const char* const>;
    return protocol == Driver::Protocol::ReachAlpha5   ? Names(kReachAxes)
           : protocol == Driver::Protocol::ReachBravo7 ? Names(kBravoAxes)
                                                       : Names(kEcaAxes);
}

[[noreturn]] void refuse(const Scene& scene, size_t row, const char* field, const std::string& value,
                         const std::string& allowed) {
    throw BadInput(scene.file.string(), "arm.driver.axes[" + std::to_string(row) + "]." + field,
                   "'" + value + "'", allowed);
}

size_t axisNamed(const Scene& scene, size_t row, const Driver& driver) {
    const auto all = namesOf(driver.protocol), names = all.first(all.size() - 1); // without the jaws
    const auto found = std::ranges::find(names, driver.axes[row].axis);
    if (found == names.end()) {
        refuse(scene, row, "axis", driver.axes[row].axis, joined(names));
    }
    return static_cast<size_t>(found - names.begin());
}

size_t jointNamed(const Scene& scene, size_t row, const Driver& driver, const ArmSetup& setup) {
    const std::vector<ArmJoint>& joints = setup.model.joints;
    const std::string& name = driver.axes[row].joint;
    const auto found = std::ranges::find(joints, name, &ArmJoint::name);
    if (found == joints.end()) {
        refuse(scene, row, "joint", name, joined(joints, &ArmJoint::name));
    }
    return static_cast<size_t>(found - joints.begin());
}

} // namespace

const char* armAxisName(Driver::Protocol protocol, size_t axis) noexcept {
    return namesOf(protocol)[axis];
}

ArmPosture ArmAxes::postureOf(const ArmFeedback& feedback) const noexcept {
    ArmPosture posture;
    for (size_t k = 0; k < joints.size(); ++k) {
        posture.q[k] = joints[k].zero + joints[k].sign * feedback.position[joints[k].axis];
    }
    posture.grasp = std::numeric_limits<double>::quiet_NaN();
    if (jaws) {
        const double share = (feedback.position[jaws->axis] - jaws->open) / (jaws->closed - jaws->open);
        posture.grasp = std::clamp(share, 0.0, 1.0);
    }
    return posture;
}

void ArmAxes::command(const ArmPosture& posture, ArmCommand& out) const noexcept {
    for (size_t k = 0; k < joints.size(); ++k) {
        out.position[joints[k].axis] = joints[k].sign * (posture.q[k] - joints[k].zero);
    }
    if (jaws) {
        out.position[jaws->axis] = jaws->open + posture.grasp * (jaws->closed - jaws->open);
    }
}

double ArmAxes::lag(const ArmPosture& wanted, const ArmPosture& measured) const noexcept {
    double most = 0.0;
    for (size_t k = 0; k < joints.size(); ++k) {
        most = std::max(most, std::abs(wanted.q[k] - measured.q[k]) / joints[k].mostLag);
    }
    return most;
}

ArmAxes chainAxes(const ArmModel& model) {
    ArmAxes axes;
    axes.joints.resize(model.count());
    for (size_t k = 0; k < model.count(); ++k) {
        axes.joints[k].axis = k;
        axes.joints[k].mostLag = model.joints[k].slides ? kSlidingLag : axes.joints[k].mostLag;
    }
    return axes;
}

ArmAxes armAxes(const Scene& scene, const ArmSetup& setup) {
    const Driver& driver = *scene.arm->driver;
    ArmAxes axes = chainAxes(setup.model);
    std::vector<bool> found(setup.model.count(), false);
    for (size_t row = 0; row < driver.axes.size(); ++row) {
        const size_t axis = axisNamed(scene, row, driver), k = jointNamed(scene, row, driver, setup);
        axes.joints[k] = {axis, driver.axes[row].sign, driver.axes[row].zero, axes.joints[k].mostLag};
        found[k] = true;
    }
    for (size_t k = 0; k < found.size(); ++k) {
        if (!found[k]) {
            throw BadInput(scene.file.string(), "arm.driver.axes",
                           "joint '" + setup.model.joints[k].name + "' has none", "one axis per joint");
        }
    }
    if (driver.jaws) {
        axes.jaws =
            ArmAxes::Jaws{namesOf(driver.protocol).size() - 1, driver.jaws->open, driver.jaws->closed};
    }
    return axes;
}

} // namespace fathom
