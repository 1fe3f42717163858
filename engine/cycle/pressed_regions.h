// SPDX-License-Identifier: Apache-2.0
// Notices that regions disappear while they press.
#pragma once

#include "engine/cycle/tool_proxy.h"
#include "engine/haptics/coupling.h"

#include <bitset>
#include <optional>
#include <span>

namespace fathom {

// The poses at the end of a step, base_T_tool.
struct StepPoses {
    Pose tool;
    Pose allowed;   // ProxyStep::allowed
    Pose springEnd; // the hand's end of the spring
};

// A step whose tool has moved. Refers to the caller's objects, so use it within the step.
struct SolvedStep {
    const ProxyStep& moved;
    const ContactSet* set; // active; null = none
    const ToolProxy& tool;
    const Pose& springEnd;  // the hand's end of the spring
    const Springs& springs; // active
    double reaction;        // [N] WrenchStage::reaction(): of the last wrench
};

// Regions that pressed in the step before and are gone.
struct VanishedRegions {
    // The direction along which the spring lost them. Zero: they pressed by a torque alone.
    dvec3 along{0.0};
    bool all = false;    // no other region holds the tool
    bool turned = false; // they held its rotation
};

// What pressed in the last step. Regions vanish when their class is no longer seen, or their shape was
// removed. Surfaces that went back so little that the tool follows them have not vanished, nor have those
// that the hand left. One thread; noexcept, no allocation.
class PressedRegions {
public:
    explicit PressedRegions(const ProxyOptions& options) noexcept
        : followed_(options.solves * options.stepCap) {}

    // Call in steps with new data, before the wrench. before: the end of the last step. Empty = none of the
    // regions that pressed then vanished.
    std::optional<VanishedRegions> vanished(const SolvedStep& step, const StepPoses& before) const noexcept;
    // Call at the end of a step, after its wrench: what presses now. touches: those of the step.
    void note(const SolvedStep& step, std::span<const Touch> touches) noexcept;

    bool any() const noexcept { return rows_; } // some region pressed in the last step
    // [m] from a pressed arm's tip to the hand's end of the spring; 0 for a tool without an arm.
    double behindHand(const ToolProxy& tool, const Pose& springEnd) const noexcept;

private:
    std::optional<dvec3> vanishedAlong(const SolvedStep& step, const StepPoses& before) const noexcept;
    bool handLeft(const SolvedStep& step, const StepPoses& before) const noexcept;
    bool wentBack(const SolvedStep& step, const dvec3& out) const noexcept;

    double followed_;          // [m] that a tool can follow in a tick
    bool rows_ = false;        // with a force that can be felt, or the length that holds with soft springs
    dvec3 spring_{0.0};        // [m] from the hand's end of the spring to where the rows held the tool
    std::bitset<64> fixtures_; // indices into Scene::fixtures whose points pressed, modulo 64
};

} // namespace fathom
