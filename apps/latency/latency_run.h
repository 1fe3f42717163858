// SPDX-License-Identifier: Apache-2.0
// Measures the threads of a realtime run: how late the haptic thread wakes, how long its step takes, and
// whether memory grows.
#pragma once

#include "apps/global_options.h"
#include "apps/latency/histogram.h"
#include "apps/session/session.h"
#include "engine/run/realtime_run.h"

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace fathom {

// One part of a measurement: one load for some seconds.
struct LatencyPart {
    std::string load;     // idle: a single frame; frames: 30 per second; window: frames and a drawing window
    double seconds = 0.0; // measured duration
    Histogram late;       // [us] delay of wake-ups after their due time
    Histogram tick;       // [us] compute time of a step
    uint64_t frames = 0;  // published frames
    uint64_t framesLost = 0;    // frames that a live camera would have dropped
    uint64_t periodsMissed = 0; // periods without a tick
    uint64_t recordsLost = 0;
    double armTravel = 0.0;     // [rad], [m] total travel of all joints; 0 without an arm or in a window
    std::vector<double> memory; // [MiB] resident memory: about 100 samples, after the first 5 %
    // [MiB] Growth of memory: largest sample of the last tenth minus largest of the first. 0 with too few
    // samples.
    double memoryGrowth() const;
    void take(const RealtimeRun& run); // reads the counts of a finished run
};

struct LatencyOptions {
    std::filesystem::path scene;
    std::string source; // like operate's --source; empty = the scene's camera
    double seconds = 10.0;
};

// Measures one part in the operator's window. Passed in, because the window depends on this folder and not
// the reverse.
using WindowLoad = std::function<LatencyPart(const LatencyOptions& options, const GlobalOptions& global)>;

// Repeats the scene's hand path through the regions. The loads idle and frames share one session.
class LatencyRun {
public:
    // Throws BadInput, Error, DeviceLost.
    LatencyRun(const LatencyOptions& options, const GlobalOptions& global, WindowLoad windowLoad,
               const std::atomic<bool>& stop);

    LatencyPart idle();
    LatencyPart frames();
    LatencyPart window();

    std::string device() const; // name of the device that computes the frames
    std::string placement() const;
    double rateHz() const;

private:
    LatencyPart run(const std::string& load, bool moving);

    LatencyOptions options_;
    GlobalOptions global_;
    WindowLoad windowLoad_;
    const std::atomic<bool>& stop_;
    ThreadPlacement placement_;
    CpuConfinement confined_; // before the device opens: the workers of a software device inherit it
    Session session_;
    HapticOptions haptics_;
};

// Resident memory of this process [MiB]; 0 when the system does not report it.
double residentMemory();

} // namespace fathom
