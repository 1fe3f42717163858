// SPDX-License-Identifier: Apache-2.0
// The part of a step that moves the tool: the active contact set, the pose that the hand commands, and the
// motion of the free tool or the arm.
#include "engine/cycle/haptic_cycle.h"

#include <algorithm>

namespace fathom {

bool HapticCycle::accepts(const ContactSet& set) noexcept {
    return arm_ ? arm_->accepts(set) : proxy_->accepts(set);
}

const ContactSet* HapticCycle::chooseSet(const StepInput& input, StepRecord& out) noexcept {
    const ContactSet* offered = input.offered;
    if (offered != nullptr && offered->frame >= 0 && accepts(*offered)) {
        out.adopted = true;
        realArm_.placed = false;
        ahead_.answered(offered->askedAt, input.time);
        return offered;
    }
    const bool usable = input.active != nullptr && input.active->frame >= 0;
    return usable && (!realArm_.placed || accepts(*input.active)) ? input.active : nullptr;
}

bool HapticCycle::follow(const ArmFollow& status) noexcept {
    realArm_.connected = arm_.has_value();
    realArm_.follows = status.follows;
    if (!realArm_.connected || !status.known || !realArm_.wasStill || !stage_.off()) {
        return false;
    }
    arm_->setPosture(status.posture);
    realArm_.placed = true;
    tool_ = arm_->tip();
    map_.align(handle_, tool_);
    device_ = springEnd_ = allowed_ = tool_;
    stage_.restart(tool_);
    ahead_.restart();
    return true;
}

double HapticCycle::sceneAge(const StepInput& input, const ContactSet* set) noexcept {
    // The active set may be older than the newest fixture set. While they are the same, the frame that
    // confirms it may be newer.
    const bool newest = set == nullptr || set->generation == input.generation;
    const double age = input.time - (newest ? input.captureTime : set->captureTime);
    regions_.age = input.sourceEnded ? std::min(age, regions_.age) : age;
    if (input.sourceEnded && newest && regions_.age > kStaleAfter) {
        regions_.age = 0.0; // the last frame does not age, however late its regions became active
    }
    return regions_.age;
}

// The hand's end of the spring: the pose that the hand commands, and the lead of guidance. The rotation is
// composed, not added to log(q_dev q^-1): equal to first order, and at rest the torque is exactly K_r times
// the lead.
Pose HapticCycle::guidedEnd() const noexcept {
    Pose end = device_;
    if (!options_.paperGuidance) {
        const auto lead = guidance_.lead(device_, watch_.springs());
        end.position += lead.translation;
        if (lead.rotation != dvec3(0.0)) {
            end.rotation = glm::normalize(rotationExp(lead.rotation) * device_.rotation);
        }
    }
    return end;
}

ProxyStep HapticCycle::moveTool(const StepInput& input, const ContactSet* set, bool newData,
                                StepRecord& out) noexcept {
    ProxyInput wanted;
    wanted.target = springEnd_;
    wanted.metricRadius = watch_.springs().metricRadius;
    wanted.contacts = set;
    wanted.deadline = input.deadline;
    wanted.surfaceMoved = newData && pressing_.rows;
    if (arm_) {
        return moveArm(input, wanted, out);
    }
    const ProxyStep moved = proxy_->step(wanted);
    tool_ = moved.pose;
    return moved;
}

// When the arm leaves the tool's direction free, the hand's rotation has no meaning. It is set to the tip's,
// so no spring turns the hand, even while the arm is held.
void HapticCycle::freeDirection(ProxyStep& moved) noexcept {
    if (armSetup_ != nullptr && armSetup_->freeDirection) {
        device_.rotation = springEnd_.rotation = moved.allowed.rotation = tool_.rotation;
    }
}

// Moves the arm's tip instead of a free tool.
ProxyStep HapticCycle::moveArm(const StepInput& input, const ProxyInput& wanted, StepRecord& out) noexcept {
    const bool button = (input.buttons & armSetup_->graspButton) != 0;
    ArmInput request{wanted, button ? 1.0 : 0.0};
    request.metricRadius = armSetup_->freeDirection ? 0.0 : wanted.metricRadius;
    const ArmStep moved = arm_->step(request);
    tool_ = moved.pose;
    jointLimits_ = moved.atPositionLimits;
    out.arm = {{moved.q, moved.grasp}, moved.residual,  moved.smallestSingularValue,
               moved.atLimits,         moved.graspHeld, moved.singular,
               moved.flipped};
    return moved;
}

void HapticCycle::recordTouches(const ContactSet* set, const ProxyStep& moved,
                                StepRecord& out) const noexcept {
    for (const ActiveContact& active : moved.active) {
        const ContactRow& row = active.row;
        if (out.touchCount == kMaxTouches) {
            return;
        }
        Touch& touch = out.touches[out.touchCount++];
        touch.kind = row.kind;
        touch.normal = row.normal;
        touch.point = tool_.position + row.arm - leafRadius(row.leaf) * row.normal;
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
