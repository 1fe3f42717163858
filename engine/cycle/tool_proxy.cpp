// SPDX-License-Identifier: Apache-2.0
#include "engine/cycle/tool_proxy.h"

namespace fathom {

ToolProxy::ToolProxy(const Tool& tool, std::span<const Shape> shapes, const ProxyOptions& options,
                     const Pose& start, const ArmSetup* arm)
    : setup_(arm) {
    if (arm != nullptr) {
        arm_.emplace(arm->model, arm->baseTarm, arm->proxy, arm->start, shapes);
        pose_ = arm_->tip();
        return;
    }
    proxy_.emplace(tool, shapes, options, start);
    pose_ = proxy_->pose();
    for (const Sphere& leaf : tool.leaves()) {
        leafRadius_.push_back(leaf.radius);
    }
}

ProxyStep ToolProxy::step(const ProxyInput& wanted, uint32_t buttons, ArmRecord& out) noexcept {
    jointLimits_ = 0;
    const ProxyStep moved = arm_ ? stepArm(wanted, buttons, out) : proxy_->step(wanted);
    pose_ = moved.pose;
    return moved;
}

ProxyStep ToolProxy::stepArm(const ProxyInput& wanted, uint32_t buttons, ArmRecord& out) noexcept {
    const bool button = (buttons & setup_->graspButton) != 0;
    ArmInput request{wanted, button ? 1.0 : 0.0};
    request.metricRadius = setup_->freeDirection ? 0.0 : wanted.metricRadius;
    const ArmStep moved = arm_->step(request);
    jointLimits_ = moved.atPositionLimits;
    out = {{moved.q, moved.grasp}, moved.residual,  moved.smallestSingularValue,
           moved.atLimits,         moved.graspHeld, moved.singular,
           moved.flipped};
    return moved;
}

void ToolProxy::putBack(const Pose& pose, ProxyStep& moved) noexcept {
    if (proxy_) {
        pose_ = moved.pose = pose;
        proxy_->setPose(pose);
    }
}

void ToolProxy::setTarget(const Pose& target) noexcept {
    if (proxy_) {
        proxy_->setTarget(target);
    }
}

void ToolProxy::setPosture(const ArmPosture& posture) noexcept {
    arm_->setPosture(posture);
    pose_ = arm_->tip();
}

void ToolProxy::record(const ContactSet* set, const ProxyStep& moved, StepRecord& out) const noexcept {
    out.tool = pose_;
    out.contactCount = static_cast<uint32_t>(moved.active.size()) + (moved.blocked ? 1 : 0);
    out.minGap = set != nullptr ? moved.minGap : kNotKnown;
    out.stalled = moved.stalled;
    out.solves = moved.solves;
    out.infeasible = moved.infeasible;
    recordTouches(set, moved, out);
}

void ToolProxy::recordTouches(const ContactSet* set, const ProxyStep& moved, StepRecord& out) const noexcept {
    for (const ActiveContact& active : moved.active) {
        const ContactRow& row = active.row;
        if (out.touchCount == kMaxTouches) {
            return;
        }
        Touch& touch = out.touches[out.touchCount++];
        touch.kind = row.kind;
        touch.normal = row.normal;
        touch.point = pose_.position + row.arm - leafRadius(row.leaf) * row.normal;
        touch.gap = row.gap;
        touch.multiplier = active.multiplier;
        touch.leaf = row.leaf;
        touch.source = row.pair;
        if (row.kind == ContactRow::Kind::Sphere && set != nullptr) {
            const uint32_t sphere = set->pairSphere[row.pair];
            touch.source = set->source[sphere];
            touch.fixture = set->fixture[sphere];
        } else if (row.kind != ContactRow::Kind::Behind) {
            touch.fixture = shapes()[row.pair].fixture;
        }
    }
}

} // namespace fathom
