// SPDX-License-Identifier: Apache-2.0
// What the writer thread of a run hands to the thread that publishes.
#pragma once

#include "devices/bag/ros2_messages.h"
#include "engine/contact/shapes.h"
#include "engine/run/channels.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace fathom {

// Sums since the start.
struct RunTotals {
    uint64_t ticks = 0, late = 0, missed = 0; // missed: periods without a step
    uint64_t sets = 0;                        // fixture sets
    double worstMicros = 0.0;                 // [us] longest step
};

// A step that is published.
struct Ros2Tick {
    uint64_t time = 0; // [ns] UTC of the step
    StepRecord record;
    bool driven = false; // a real arm follows
    ArmState armState = ArmState::Silent;
    RunTotals totals;
    std::optional<Pose> baseTcamera; // of the newest set
};

// A joint of the tool's arm.
struct Ros2Joint {
    std::string name;
    bool slides = false;  // prismatic
    bool follows = false; // another joint (<mimic>)
};

// Regions and shapes that are active now.
struct Ros2Regions {
    uint64_t time = 0;                     // [ns] UTC, when they were queued
    std::vector<ros2::RegionPoint> points; // base frame
    std::vector<Shape> shapes;
};

// Dates the steps of a run by UTC. Steps arrive late by varying times, so the earliest arrival counts.
class TickStamps {
public:
    // t [s]: of the run; it begins again with each run. Returns [ns].
    uint64_t at(double t) noexcept;

private:
    double last_ = 0.0, zero_ = 0.0; // [s] zero_: CLOCK_MONOTONIC at t = 0
    bool any_ = false;
};

// Chooses the steps that are published. Keeps the average rate, though steps have a raster of their own.
class MessagePace {
public:
    // period [s]: from one message to the next.
    explicit MessagePace(double period)
        : period_(period) {}
    // t [s]: of the run; it begins again with each run.
    bool due(double t) noexcept;

private:
    static constexpr double kSlack = 1e-4; // [s]
    double period_, next_ = 0.0, last_ = 0.0;
};

} // namespace fathom
