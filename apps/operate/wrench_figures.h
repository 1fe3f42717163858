// SPDX-License-Identifier: Apache-2.0
// The figures of force and torque that bars, traces and state file share.
#pragma once

#include "apps/operate/run_view.h"
#include "apps/operate/theme.h"
#include "engine/cycle/haptic_options.h"
#include "engine/cycle/step_record.h"

#include <array>

namespace fathom::operate {

// Share of a bar or of half a plot at which the limit is; what is beyond it stays visible.
inline constexpr float kLimitShare = 0.9f;

inline constexpr double kAtLimit = 0.98; // of a limit, from which it counts as reached

// Whether the force, or the torque, of a tick has reached its limit; with what the device cannot render.
bool atForceLimit(const StepRecord& record, const HapticOptions& limits);
bool atTorqueLimit(const StepRecord& record, const HapticOptions& limits);

// Tooltips of bars and traces.
inline constexpr const char* kForceTip =
    "Force that the device gives to the hand. The red line is the limit, which the scale ends at; the "
    "peak is of the last ten seconds. Ripple: RMS change from frame to frame in one second.";
inline constexpr const char* kTorqueTip =
    "Torque that the device gives to the hand, about the tool's centre. What its motors cannot render is the "
    "residual, which is only shown.";

// Force or torque at the end of a trace; sizes of vectors, in the unit.
struct WrenchFigures {
    const char* name = "";
    const char* unit = "";
    glm::vec3 TraceWrench::*part = nullptr;
    ImU32 colour = 0;
    double limit = 0.0;
    double delivered = 0.0, whole = 0.0;
    double residual = 0.0; // what the device does not render; NaN: not recorded
    double peak = 0.0;     // largest delivered one of the trace
    double ripple = 0.0;   // frame_ripple.h; NaN: unknown

    bool saturated() const { return whole > kAtLimit * limit; }
    bool renderedInPart() const { return residual > 0.005 * limit; }
};

// Force, then torque.
std::array<WrenchFigures, 2> figuresOf(const std::deque<TraceSample>& trace, const Peaks& peaks,
                                       const FrameRipple& ripple, const HapticOptions& limits);
inline std::array<WrenchFigures, 2> figuresOf(const RunView& run, const HapticOptions& limits) {
    return figuresOf(run.trace(), run.peaks(), run.ripple(), limits);
}

} // namespace fathom::operate
