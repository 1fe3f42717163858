// SPDX-License-Identifier: Apache-2.0
#include "engine/haptics/arm_proxy.h"

#include "engine/haptics/constrained_proxy_rows.h"

#include <cmath>

namespace fathom {

namespace {

constexpr int kGraspTries = 6;

Tool toolAtZero(const ArmModel& arm, const Pose& baseTarm) {
    ArmFrames frames;
    arm.place(JointVector{}, baseTarm, frames);
    return armTool(arm, frames);
}

} // namespace

template class ConstrainedProxy<ArmKinematics>;

Tool armTool(const ArmModel& arm, const ArmFrames& frames) {
    SphereTree tree; // one level of leaves in the arm's own order under one root
    tree.levels = 2;
    tree.degree = static_cast<uint32_t>(arm.leaves.size());
    tree.nodes.resize(arm.leaves.size() + 1);
    Sphere& root = tree.nodes[0];
    root = {arm.centre(frames, 0), 0.0};
    for (size_t i = 0; i < arm.leaves.size(); ++i) {
        tree.nodes[i + 1] = {arm.centre(frames, i), arm.leaves[i].sphere.radius};
        root.radius = std::max(root.radius, glm::distance(root.centre, tree.nodes[i + 1].centre) +
                                                tree.nodes[i + 1].radius);
    }
    root.radius *= 1.0 + 1e-9;
    return Tool(std::move(tree));
}

ArmProxy::ArmProxy(const ArmModel& arm, const Pose& baseTarm, const ArmProxyOptions& options,
                   const JointVector& start, std::span<const Shape> shapes)
    : ConstrainedProxy(toolAtZero(arm, baseTarm), shapes, options, ArmKinematics(arm, baseTarm, options))
    , hasFingers_(!arm.fingers.empty())
    , graspPerTick_(options.graspPerTick) {
    for (size_t i = 0; i < arm.leaves.size(); ++i) {
        if (!arm.moves(i)) {
            contacts_.exclude(i);
        }
    }
    setPosture({start, 0.0});
}

// The fingers move first, alone, with the same exact check as any motion.
void ArmProxy::moveGrasp(double grasp, ArmStep& out) noexcept {
    if (!std::isfinite(grasp) || !hasFingers_) {
        return;
    }
    const double now = posture().grasp;
    double change = std::clamp(std::clamp(grasp, 0.0, 1.0) - now, -graspPerTick_, graspPerTick_);
    if (change == 0.0) {
        return;
    }
    contacts_.gather(tip().position, true);
    findNearShapes();
    for (int tries = 0; tries < kGraspTries; ++tries, change *= 0.5) {
        kinematics_.tryGrasp(now + change, contacts_.leaves);
        if (contacts_.leaves.travel() <= options_.stepCap && allowed(false)) {
            out.graspHeld = tries > 0;
            kinematics_.commit();
            contacts_.leaves.now.swap(contacts_.leaves.next);
            return;
        }
    }
    out.graspHeld = true;
}

ArmStep ArmProxy::step(const ArmInput& input) noexcept {
    ArmStep out;
    if (begin(input)) {
        moveGrasp(input.grasp, out);
        finish(input, out);
    }
    report(out);
    return out;
}

} // namespace fathom
