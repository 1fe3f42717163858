// SPDX-License-Identifier: Apache-2.0
// The hand in the base frame, and how it is re-indexed.
#pragma once

#include "engine/cycle/haptic_options.h"
#include "engine/cycle/pressed_regions.h"
#include "engine/haptics/guidance.h"
#include "engine/haptics/hand_map.h"

#include <optional>
#include <span>

namespace fathom {

// A re-indexing: the pose that the hand commands was moved by `by` [m] and turned by `turn`, not by the
// hand.
struct HandShift {
    dvec3 by{0.0};
    dquat turn{1.0, 0.0, 0.0, 0.0};
};

// From the raw sample over the hand map and guidance to the hand's end of the spring, which the solver aims
// at. recentre(), keepAt() and takeUpLag() re-index the hand and return the shift, for others that keep its
// poses. One thread. Allocates nothing; only the constructor throws. Poses are base_T_tool.
class MappedHand {
public:
    // start: raw pose before the first step. It commands `tool`, if given. `options` must outlive this.
    MappedHand(const HapticOptions& options, const Pose& start, const std::optional<Pose>& tool);

    // Takes a good raw sample. clutch: the device pose stays. reindex: first re-indexes the hand, so that
    // this sample commands the former device pose.
    void take(const Pose& deviceThandle, bool reindex, bool clutch) noexcept;
    // Guidance of a step, after take(): eases its pull in or out, or off if `cut`, and moves springEnd().
    void guide(std::span<const GuidancePose> targets, bool button, bool cut, const Springs& springs) noexcept;
    // Sets device pose and spring's end to `pose` before the first step; the hand map stays.
    void start(const Pose& pose) noexcept { device_ = springEnd_ = pose; }

    // Hand and tool start anew at `tool`: re-indexes the hand.
    void restart(const Pose& tool) noexcept;
    // A region stopped the tool, and the hand moved farther: moves device() to the tool. Call it only while
    // there is no force.
    HandShift recentre(const Pose& tool) noexcept;
    // Pressed regions vanished, and `tool` stays. The part of the spring that they held is taken out of the
    // hand map, and so out of moved.allowed. allowedBefore: of the last step.
    HandShift keepAt(const Pose& tool, const VanishedRegions& gone, const Pose& allowedBefore,
                     ProxyStep& moved) noexcept;
    // Takes up a lag of a free tool that lasts, a part per step. Sets StepRecord::lag.
    std::optional<HandShift> takeUpLag(const ToolProxy& tool, ProxyStep& moved, StepRecord& out) noexcept;
    // The arm leaves the tool's direction free: turns the hand's poses to the tip's rotation until the next
    // take().
    void turnTo(const dquat& rotation) noexcept { device_.rotation = springEnd_.rotation = rotation; }

    const Pose& handle() const noexcept { return handle_; } // raw, last good sample
    const Pose& device() const noexcept { return device_; } // mapped
    // The hand's end of the spring: the device pose moved by the guidance lead.
    const Pose& springEnd() const noexcept { return springEnd_; }
    dquat baseRhandle() const noexcept { return map_.baseRhandle(handle_); }
    Wrench toDevice(const Wrench& base) const noexcept { return map_.toDevice(base); }
    // The part of the spring wrench that guidance adds. It moves the hand on purpose, so the passivity
    // controller excludes it.
    Wrench pull(const Springs& springs) const noexcept;
    // Device pose, guidance and shifts for the record of a step.
    void record(StepRecord& out) const noexcept;

    static constexpr double kLagLength = 1e-4; // [m] a smaller lag counts as none
    static constexpr double kLagTime = 0.05;   // [s] of lag before the hand map takes it up
    static constexpr double kTakeUpTime = 0.2; // [s] time constant of that

private:
    Pose guidedEnd(const Springs& springs) const noexcept;
    void apply(const HandShift& shift) noexcept;

    const HapticOptions& options_;
    HandMap map_;
    Guidance guidance_;
    Pose handle_;
    Pose device_, springEnd_;
    double lagTime_ = 0.0;  // [s] for which the tool has been lagging
    dvec3 total_{0.0};      // [m] of all shifts, over the run
    uint32_t vanished_ = 0; // times that pressed regions vanished, over the run
};

} // namespace fathom
