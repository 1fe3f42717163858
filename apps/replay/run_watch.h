// SPDX-License-Identifier: Apache-2.0
// Watches the frames and ticks of a run for protection that is silently off.
#pragma once

#include "engine/cloud/collect.h"
#include "engine/scene/scene.h"
#include "engine/types/run_warnings.h"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace fathom {

// Where the frames of a run come from.
struct RunSource {
    CameraInfo camera;
    std::string streams; // Camera::streams(), for warnings; may be empty
};

// Warns once per class and per state. One thread.
class RunWatch {
public:
    static constexpr double kPatience = 1.0; // [s] that a class may have no point, or a state give no force

    // Adds the gates of the scene that no point can pass, and settings without a force that a hand feels.
    RunWatch(const Scene& scene, const RunSource& source);

    // The fixtures after an edit, for the frames from now on. The classes of points have kept their rows.
    void setFixtures(const std::vector<FixtureClass>& fixtures);
    // A frame at t [s] with its counts, its set and its colours (R8 G8 B8 A8, may be empty).
    void frame(double t, const cloud::FrameCounts& counts, const HostFixtures& set,
               std::span<const uint32_t> colour);
    // A tick at t [s]: its state as in haptics.csv, the frame of its active set (-1 = none), and how often
    // regions have disappeared while they pressed (StepRecord::vanished).
    void tick(double t, std::string_view state, int64_t frame, uint32_t vanished);
    // Call once after the last tick: short runs have not used up the patience.
    void end();

    RunWarnings& warnings() { return warnings_; }

private:
    struct ClassState {
        size_t row = 0;             // of Scene::fixtures
        std::optional<double> none; // [s] since when it has no point; empty = it has some
        bool ever = false;          // it had a point in the run
        std::string cause;
    };
    // A state without the force of a contact, while it lasts.
    struct StateSpan {
        std::string state;
        double since = 0.0; // [s]
        int64_t frame = -1; // of the active set; -1 = none
    };
    struct Rate {
        double frameAt = 0.0;                      // [s] of the newest frame
        uint32_t intervals = 0, longIntervals = 0; // between frames; those in which forces fade
        bool framed = false;
    };
    // Why the class has no point in the frame of this set.
    std::string causeOf(const ClassState& state, uint32_t marked, uint32_t valid, const HostFixtures& set,
                        std::span<const uint32_t> colour) const;
    uint32_t sharedPixels(const cloud::FrameCounts& counts) const;
    void warnClass(const ClassState& state, const std::string& since);
    void warnState(double seconds);
    void warnVanished(double t);
    void watchRate(double t);
    std::string causeOfState() const;

    std::vector<FixtureClass> fixtures_;
    std::string streams_;
    double nearZ_, farZ_;             // [m]
    std::vector<ClassState> classes_; // in the order of the mask's bits
    RunWarnings warnings_;
    StateSpan span_;
    double last_ = 0.0;               // [s] of the newest tick
    uint64_t ticks_ = 0, active_ = 0; // active: ticks free or in contact
    uint32_t vanished_ = 0;
    Rate rate_;
};

} // namespace fathom
