// SPDX-License-Identifier: Apache-2.0
#include "engine/haptics/arm_proxy.h"

#include "engine/haptics/arm_damping.h"
#include "engine/haptics/proxy_limits.h"
#include "engine/haptics/row_rules.h"

#include <algorithm>
#include <cmath>

namespace fathom {

namespace {

constexpr double kFarthestAim = 2.0; // times the step cap

} // namespace

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
    : arm_(arm)
    , base_(baseTarm)
    , options_(options)
    , n_(arm.count())
    , shapes_(shapes.begin(), shapes.end())
    , narrow_(
          [&] {
              ArmFrames frames;
              arm.place(JointVector{}, baseTarm, frames);
              return armTool(arm, frames);
          }(),
          kMostLeafRows)
    , trust_(arm.leaves.size())
    , solver_(static_cast<int>(arm.count()), kMostRows)
    , places_(arm)
    , leaves_(arm.leaves.size())
    , nextLeaves_(arm.leaves.size())
    , exempt_(arm.leaves.size(), dvec3(0.0))
    , clearance_(arm.leaves.size(), 0.0)
    , violations_(kMostViolations)
    , rows_(kMostRows) {
    for (size_t k = 0; k < n_; ++k) {
        q_[k] = std::clamp(0.0, arm.joints[k].lower, arm.joints[k].upper);
    }
    shapes_.reserve(std::max(Proxy::kSpareShapes, shapes_.size()));
    setPosture({start, grasp_});
    origin_ = frames_[0].position;
    places_.place(frames_, origin_, leaves_);
}

void ArmProxy::setPosture(const ArmPosture& posture) noexcept {
    for (size_t k = 0; k < n_; ++k) {
        const double q = std::isfinite(posture.q[k]) ? posture.q[k] : q_[k];
        q_[k] = std::clamp(q, arm_.joints[k].lower, arm_.joints[k].upper);
    }
    grasp_ = std::isfinite(posture.grasp) ? std::clamp(posture.grasp, 0.0, 1.0) : grasp_;
    start_ = q_;
    arm_.place(q_, base_, frames_, grasp_);
    places_.place(frames_, origin_, leaves_);
}

void ArmProxy::setShapes(std::span<const Shape> shapes) noexcept {
    const size_t count = std::min(shapes.size(), shapes_.capacity());
    shapes_.assign(shapes.begin(), shapes.begin() + static_cast<std::ptrdiff_t>(count));
}

bool ArmProxy::covers(const ContactSet& contacts) noexcept {
    if (contacts.leafAtQuery.size() != arm_.leaves.size()) {
        return false;
    }
    origin_ = contacts.origin;
    places_.place(frames_, origin_, leaves_);
    return TrustRegion::covers(contacts, leaves_);
}

ArmProxy::Goal ArmProxy::aim(const ArmInput& input, ArmStep& out) noexcept {
    const Pose now = tip();
    const double k = input.metricRadius;
    // A target far away bends the way there: only what a solve can go is asked for, or a stretched arm
    // dances.
    Motion left = remaining(now, input.target);
    left = std::min(1.0, kFarthestAim * options_.stepCap / lengthOf(left, k)) * left;
    ArmNormal normal(n_);
    for (size_t j = 0; j < n_; ++j) {
        const dvec3 turning = arm_.joints[j].slides ? dvec3(0.0) : arm_.axisOf(frames_, j);
        normal.setColumn(j, arm_.motionOf(frames_, j, now.position), k * turning);
        if (arm_.joints[j].lower == arm_.joints[j].upper) {
            normal.leaveOut(j);
        }
    }
    const double smallest = normal.smallestSingular(k == 0.0 ? 3 : 6);
    if (out.solves == 0) {
        out.manipulability = smallest;
        out.singular = smallest < options_.singularBelow;
    }
    Goal goal;
    goal.lambda = dampingFor(smallest, options_.singularBelow, options_.damping, options_.singularDamping);
    normal.damp(goal.lambda);
    normal.solve(left.a, k * left.alpha, goal.wanted);
    solver_.setMetric(normal.metric());
    return goal;
}

// The fingers go first, by themselves: what they may do is looked at as exactly as any motion.
void ArmProxy::moveGrasp(const ArmInput& input, ArmStep& out) noexcept {
    if (!std::isfinite(input.grasp) || arm_.fingers.empty()) {
        return;
    }
    const double wanted = std::clamp(input.grasp, 0.0, 1.0) - grasp_;
    double change = std::clamp(wanted, -options_.graspPerTurn, options_.graspPerTurn);
    if (change == 0.0) {
        return;
    }
    if (input.contacts != nullptr) {
        gather(*input.contacts, true);
    }
    out.graspHeld = true;
    for (int tries = 0; tries < 6 && out.graspHeld; ++tries, change *= 0.5) {
        size_t violating = 0;
        tryPosture(q_, grasp_ + change);
        if (leafDisplacement(leaves_, nextLeaves_) <= options_.stepCap &&
            allowed(input.contacts, violating)) {
            out.graspHeld = tries > 0;
            take();
            return;
        }
    }
}

ArmStep ArmProxy::step(const ArmInput& asked) noexcept {
    ArmStep out;
    start_ = q_;
    escapeLeft_ = options_.escapePerTurn;
    activeCount_ = 0;
    ArmInput input = asked;
    input.metricRadius = std::isfinite(asked.metricRadius) ? std::clamp(asked.metricRadius, 0.0, 10.0) : 0.0;
    const ContactSet* contacts = input.contacts;
    const bool usable = contacts == nullptr || contacts->leafAtQuery.size() == arm_.leaves.size();
    if (usable) {
        origin_ = contacts != nullptr ? contacts->origin : frames_[0].position;
        places_.place(frames_, origin_, leaves_);
        if (contacts != nullptr) {
            proxy::flagBehind(*contacts, leaves_, exempt_, clearance_);
        } else {
            std::fill(exempt_.begin(), exempt_.end(), dvec3(0.0));
        }
        moveGrasp(input, out);
    }
    while (usable && isFinite(input.target) && out.solves < options_.solves && step(input, out)) {
        if (input.deadline.passed != nullptr && input.deadline.passed(input.deadline.context)) {
            break;
        }
    }
    report(input, usable, out);
    return out;
}

void ArmProxy::report(const ArmInput& input, bool usable, ArmStep& out) noexcept {
    out.q = q_;
    out.grasp = grasp_;
    out.tip = tip();
    out.residual = lengthOf(remaining(out.tip, input.target), input.metricRadius);
    out.active = {active_.data(), activeCount_};
    if (input.contacts != nullptr && usable) {
        out.minGap = narrow_.smallestGapAt(*input.contacts, leaves_);
    }
}

} // namespace fathom
