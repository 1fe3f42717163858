// SPDX-License-Identifier: Apache-2.0
// Copies of run data for the window: the writer thread publishes them and never waits for the window.
#pragma once

#include "engine/run/record_drain.h"
#include "engine/types/spsc_queue.h"
#include "engine/types/triple_buffer.h"

#include <vector>

namespace fathom::operate {

// One frame and its fixture set.
struct SceneSnapshot {
    bool any = false;   // false before the first frame
    FrameReport report; // passMs is empty for a repeated frame and while frozen
    double t = 0.0;     // [s] capture time in the run
    HostFixtures set;
    std::vector<uint32_t> colour;
    uint64_t number = 0; // number of the frame
};

// Called on the writer thread. A slow window gets the newest frame only; ticks that do not fit are counted in
// ticks().dropped().
class SnapshotSink final : public ForwardingSink {
public:
    // `next` outlives this.
    explicit SnapshotSink(RunSink& next)
        : ForwardingSink(next)
        , ticks_(8192) {}

    void frame(const PublishedFrame& frame, const HostFixtures& set) override;
    void step(const TickRow& row, const ObeyedSet& obeyed) override;

    TripleBuffer<SceneSnapshot>& scene() { return scene_; } // read by the window
    SpscQueue<TickRow>& ticks() { return ticks_; }

private:
    TripleBuffer<SceneSnapshot> scene_;
    SpscQueue<TickRow> ticks_;
    uint64_t frames_ = 0;
};

} // namespace fathom::operate
