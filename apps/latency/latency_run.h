// SPDX-License-Identifier: Apache-2.0
// Measures the threads of a real-time run: how late the haptic thread wakes, how long its step takes, whether
// memory stays flat.
#pragma once

#include "apps/global_options.h"
#include "apps/latency/histogram.h"
#include "apps/session/session.h"
#include "engine/run/realtime_run.h"

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace fathom {

// One part of a measurement: one load for some seconds.
struct LatencyPart {
    std::string
        load; // idle: one frame, then none; frames: 30 a second; window: frames, and the window drawing
    double seconds = 0.0;       // that it really took
    Histogram late;             // [us] wake-ups after they were due
    Histogram tick;             // [us] compute time of a step
    uint64_t frames = 0;        // published
    uint64_t framesLost = 0;    // that a live camera would have dropped
    uint64_t periodsMissed = 0; // without a step
    uint64_t recordsLost = 0;
    double armTravel = 0.0;     // [rad], [m] that all joints went, added up; 0 without an arm or in a window
    std::vector<double> memory; // [MiB] resident, about 100 over the part, after its first 5 %
    // [MiB] growth from the first tenth of the samples to the last, by the maximum of each; 0 when there are
    // too few.
    double memoryGrowth() const;
    void take(const RealtimeRun& run); // its counts, after the run
};

struct LatencyOptions {
    std::filesystem::path scene;
    std::string source; // as of operate; empty = the scene's camera
    double seconds = 10.0;
};

// Measures one part in the operator's window. From outside: the window depends on this folder, not the
// reverse.
using WindowLoad = std::function<LatencyPart(const LatencyOptions& options, const GlobalOptions& global)>;

// The scene's hand path drives through the regions, again and again. The loads idle and frames share one
// session.
class LatencyRun {
public:
    // Throws BadInput, Error, DeviceLost.
    LatencyRun(const LatencyOptions& options, const GlobalOptions& global, WindowLoad windowLoad,
               const std::atomic<bool>& stop);

    LatencyPart idle();
    LatencyPart frames();
    LatencyPart window();

    std::string device() const; // that computes the frames
    std::string placement() const;
    double rateHz() const;

private:
    LatencyPart run(const std::string& load, bool moving);

    LatencyOptions options_;
    GlobalOptions global_;
    WindowLoad windowLoad_;
    const std::atomic<bool>& stop_;
    ThreadPlacement placement_;
    CpuConfinement confined_; // before the device: the workers of a software device inherit it
    Session session_;
    HapticOptions haptics_;
};

// [MiB] resident memory of this process; 0 when the system does not report it.
double residentMemory();

} // namespace fathom
