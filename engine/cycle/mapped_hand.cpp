// SPDX-License-Identifier: Apache-2.0
#include "engine/cycle/mapped_hand.h"

#include "engine/haptics/limits.h"

namespace fathom {
namespace {

constexpr dquat kNoTurn{1.0, 0.0, 0.0, 0.0};

} // namespace

MappedHand::MappedHand(const HapticOptions& options, const Pose& start, const std::optional<Pose>& tool)
    : options_(options)
    , map_(options.baseRdevice, options.handScale)
    , guidance_(options.guidance)
    , handle_{start.position, glm::normalize(start.rotation)} {
    if (tool) {
        map_.align(start, *tool);
    }
    device_ = springEnd_ = tool ? *tool : map_.map(start, false);
}

void MappedHand::take(const Pose& deviceThandle, bool reindex, bool clutch) noexcept {
    handle_ = {deviceThandle.position, glm::normalize(deviceThandle.rotation)};
    if (reindex) {
        map_.align(handle_, device_);
    }
    device_ = map_.map(handle_, clutch);
}

void MappedHand::guide(std::span<const GuidancePose> targets, bool button, bool cut,
                       const Springs& springs) noexcept {
    guidance_.step(targets, device_, button, cut, options_.period,
                   options_.paperGuidance ? guidance_.pullReach(springs) : guidance_.leadReach(springs));
    springEnd_ = guidedEnd(springs);
}

// The rotation is composed, not added to log(q_dev q^-1): equal to first order, and at rest the torque is
// exactly K_r times the lead.
Pose MappedHand::guidedEnd(const Springs& springs) const noexcept {
    Pose end = device_;
    if (!options_.paperGuidance) {
        const auto lead = guidance_.lead(device_, springs);
        end.position += lead.translation;
        if (lead.rotation != dvec3(0.0)) {
            end.rotation = glm::normalize(rotationExp(lead.rotation) * device_.rotation);
        }
    }
    return end;
}

Wrench MappedHand::pull(const Springs& springs) const noexcept {
    return options_.paperGuidance ? guidance_.pull(device_, springs) : couple(springs, springEnd_, device_);
}

void MappedHand::restart(const Pose& tool) noexcept {
    map_.align(handle_, tool);
    device_ = springEnd_ = tool;
}

HandShift MappedHand::recentre(const Pose& tool) noexcept {
    const dvec3 by = tool.position - device_.position;
    map_.align(handle_, tool);
    device_ = tool;
    return {by, kNoTurn};
}

// Moves the hand map, and with it the poses that the hand commands.
void MappedHand::apply(const HandShift& shift) noexcept {
    const auto& [by, turn] = shift;
    device_ = {device_.position + by, glm::normalize(turn * device_.rotation)};
    springEnd_ = {springEnd_.position + by, glm::normalize(turn * springEnd_.rotation)};
    map_.shift(by);
    if (turn != kNoTurn) {
        map_.align(handle_, device_);
    }
    guidance_.shift(by, turn);
    total_ += by;
}

HandShift MappedHand::keepAt(const Pose& tool, const VanishedRegions& gone, const Pose& allowedBefore,
                             ProxyStep& moved) noexcept {
    const dvec3 apart = tool.position - springEnd_.position;
    const dvec3 by = gone.all ? apart : projectedOn(apart, gone.along);
    const dvec3 free = by + projectedOn(moved.stuck, gone.along); // friction ends with what it held back
    const HandShift shift{by, gone.turned ? tool.rotation * glm::conjugate(springEnd_.rotation) : kNoTurn};
    apply(shift);
    if (gone.all) {
        moved.allowed = springEnd_;
    } else if (gone.turned) { // the solver allowed a position for a tool that turns
        const bool moves = glm::dot(gone.along, gone.along) > 0.0;
        moved.allowed = {(moves ? moved.allowed : allowedBefore).position + free, tool.rotation};
    } else {
        moved.allowed.position += free;
    }
    moved.cut = !gone.all;
    ++vanished_;
    lagTime_ = 0.0;
    return shift;
}

std::optional<HandShift> MappedHand::takeUpLag(const ToolProxy& tool, ProxyStep& moved,
                                               StepRecord& out) noexcept {
    const dvec3 lag = moved.cut ? moved.allowed.position - tool.pose().position : dvec3(0.0);
    out.lag = glm::length(lag);
    lagTime_ = out.lag > kLagLength ? lagTime_ + options_.period : 0.0;
    if (!(lagTime_ > kLagTime) || tool.onArm()) {
        return std::nullopt;
    }
    const HandShift shift{-(options_.period / kTakeUpTime) * lag, kNoTurn};
    apply(shift);
    moved.allowed.position += shift.by;
    return shift;
}

void MappedHand::record(StepRecord& out) const noexcept {
    out.device = device_;
    out.guidance = guidance_.weight();
    out.guidanceClass = guidance_.chosen();
    out.guidanceTarget = guidance_.target();
    out.indexShift = total_;
    out.vanished = vanished_;
}

} // namespace fathom
