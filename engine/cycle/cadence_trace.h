// SPDX-License-Identifier: Apache-2.0
// Trace of the three cadences: one track each, and the steps of a frame in time.
#pragma once

#include "engine/cycle/frame_cycle.h"
#include "engine/cycle/trace.h"

namespace fathom {

// Each function is called by the thread of its cadence. Another thread drains and finishes the trace (in
// lockstep the same one). frame(), query() and step() are wait-free and do not allocate.
class CadenceTrace {
public:
    // passes: FrameCycle::passNames(). Throws like Trace.
    CadenceTrace(const std::filesystem::path& file, const std::vector<std::string>& passes);

    // Writes an instant at the capture, spans for upload and publish, and the passes on the device's track.
    // The time of a pass is the submission's plus the device's intervals since, because the two clocks are
    // not calibrated.
    void frame(const FrameReport& report) noexcept;
    void query(TraceTime begin, TraceTime end, size_t spheres) noexcept;
    // lateSeconds: delay of the step's start after its due time.
    void step(TraceTime begin, TraceTime end, double lateSeconds) noexcept;

    Trace& file() { return trace_; }

private:
    Trace trace_;
    TraceTrack& frames_;
    TraceTrack& device_;
    TraceTrack& contact_;
    TraceTrack& haptic_;
    std::vector<const char*> passes_;
};

} // namespace fathom
