// SPDX-License-Identifier: Apache-2.0
// The trace of the three cadences: which track each writes, and a frame's steps laid out in time.
#pragma once

#include "engine/cycle/frame_cycle.h"
#include "engine/cycle/trace.h"

namespace fathom {

// Each function belongs to the thread of its cadence; the trace is drained and finished by another (or, in
// lockstep, the same). frame(), query() and turn() are wait-free and allocate nothing.
class CadenceTrace {
public:
    // passes: FrameCycle::passNames(). Throws what Trace throws.
    CadenceTrace(const std::filesystem::path& file, const std::vector<std::string>& passes);

    // Instant at the capture, spans of upload and publish, and the passes on the device's own track. A pass
    // lies where the submission and the device's intervals since put it: device and host clocks are not
    // calibrated against each other.
    void frame(const FrameReport& report) noexcept;
    void query(TraceTime begin, TraceTime end, size_t spheres) noexcept;
    // lateSeconds: from when the tick was due to its start.
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
