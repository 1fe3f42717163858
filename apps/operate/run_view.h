// SPDX-License-Identifier: Apache-2.0
// The window's view of the run: newest frame and tick, ten seconds of trace, rates.
#pragma once

#include "apps/operate/frame_ripple.h"
#include "apps/operate/snapshots.h"

#include <cstddef>
#include <deque>
#include <optional>
#include <utility>
#include <vector>

namespace fathom::operate {

// Base axes; torque about the tool's centre.
struct TraceWrench {
    glm::vec3 force{0.0f};  // [N]
    glm::vec3 torque{0.0f}; // [N m]
};

// Why a tick's force fades, or has faded out while forces are on: the first that applies.
enum class FadeReason : uint8_t {
    Unknown,
    OldFrame,      // isOld()
    SwitchedOff,   // the dead-man switch is open, which the window's switch also sets
    ArmStill,      // a real arm does not follow
    DeviceLost,    // the device is gone or silent
    RegionGone,    // regions that pressed disappeared
    DeviceWasLost, // several times, or a moment ago: forces wait
};

// One tick in the traces.
struct TraceSample {
    double t = 0.0;       // [s]
    TraceWrench whole;    // after all limits
    TraceWrench residual; // the part that the device cannot render; NaN: not recorded
    int64_t frame = -1;   // frame whose set was used
    StepState state = StepState::Off;
    bool guided = false, late = false;
    FadeReason fade = FadeReason::Unknown; // of the state Fading
    // What the hand gets; without a known residual, all of it.
    TraceWrench delivered() const;
};
TraceSample sampleOf(const TickRow& row);

// The largest delivered force and torque of a trace.
struct Peaks {
    double force = 0.0, torque = 0.0; // [N], [N m]
};

// Sliding maximum over a time span.
class PeakHold {
public:
    void add(double t, float value, double span); // [s]
    double value() const { return falling_.empty() ? 0.0 : double{falling_.front().second}; }

private:
    std::deque<std::pair<double, float>> falling_; // values that no later one exceeds, with their times
};

struct Rates { // over the last second
    double hapticHz = 0.0, worstPeriodMs = 0.0, cameraHz = 0.0;
};

// Age of a frame at the first tick that used it, over the last second [s]; NaN = no frame.
struct FrameDelay {
    double median = kNotKnown, worst = kNotKnown;
};

// A block: a contact that keeps the tool from following the hand over consecutive ticks.
struct Block {
    Touch touch;                    // the newest one
    int64_t sinceFrame = 0;         // frame whose set was used when the block began
    double since = 0.0, last = 0.0; // [s]
    double deepest = 0.0;           // [m] largest distance of the hand beyond it
    double beyond = 0.0;            // [m] now
    double force = 0.0;             // [N] now, total on the hand
};

// A measured posture of a real arm.
struct Measured {
    double t = 0.0; // [s]
    ArmPosture posture;
};

// Window thread. Keeps what the window shows of the run.
class RunView {
public:
    static constexpr double kSpan = 10.0; // [s] of trace

    explicit RunView(SnapshotSink& sink)
        : sink_(sink) {}

    // For playback: rewind() discards all ticks, take() adds recorded ones.
    void rewind();
    void take(const TickRow& row);

    // Reads everything new from the sink; true when there is a new frame.
    bool refresh();

    const SceneSnapshot& scene() const { return sink_.scene().front(); }
    const TickRow& step() const { return seen_.tick; }
    // last measurement; empty = never measured
    const std::optional<Measured>& measured() const { return seen_.measured; }
    bool anyTick() const { return seen_.ticks > 0; }
    // Whether regions disappeared while they pressed, so recently that their force may still fade.
    bool regionsVanished() const { return seen_.tick.record.t - seen_.vanishedAt <= 5.0; }
    // Whether the device was gone or silent so recently that it may still hold forces off.
    bool deviceWasLost() const { return seen_.tick.record.t - seen_.lostAt <= 2.0; }
    // Of the newest tick, whose state is Fading or Off.
    FadeReason fadeReason() const;
    uint64_t ticks() const { return seen_.ticks; }
    const std::deque<TraceSample>& trace() const { return seen_.trace; }
    Peaks peaks() const { return {seen_.force.value(), seen_.torque.value()}; } // of the trace
    uint64_t restarts() const { return restarts_; }                             // calls of rewind()
    const FrameRipple& ripple() const { return seen_.ripple; }
    // newest first; one per kind, fixture and leaf
    const std::deque<Block>& blocks() const { return seen_.blocks; }
    Rates rates() const;
    FrameDelay delay() const;
    // Of the last million ticks, unordered.
    const std::vector<float>& stepMicros() const { return seen_.micros; }
    // also of the last million ticks
    const std::vector<float>& wokenLateMicros() const { return seen_.wokenLate; }
    uint64_t lateTicks() const { return seen_.late; }
    const std::vector<double>& passMs() const { return passMs_; } // of the last frame that was processed

private:
    void noteDelay(const StepRecord& record);
    void noteBlocks(const TickRow& row);

    static constexpr double kNever = -1e9; // [s]

    // What rewind() discards.
    struct Seen {
        TickRow tick; // the newest one
        std::optional<Measured> measured;
        double vanishedAt = kNever, lostAt = kNever; // [s] of the newest ticks with it
        uint64_t ticks = 0, late = 0;
        std::deque<TraceSample> trace;
        PeakHold force, torque;
        FrameRipple ripple;
        std::deque<double> captures;                  // [s] capture times of the last second
        std::deque<std::pair<double, double>> delays; // time of the tick and age of its new frame [s]
        int64_t usedFrame = -1;                       // of the newest tick
        std::deque<Block> blocks;
        std::vector<float> micros, wokenLate;
    };

    SnapshotSink& sink_;
    Seen seen_;
    uint64_t restarts_ = 0;
    std::vector<double> passMs_;
};

} // namespace fathom::operate
