// SPDX-License-Identifier: Apache-2.0
// Keeps the last half minute of a run in memory, so that a key can store what has just happened.
#pragma once

#include "apps/operate/recorded_edits.h"
#include "engine/run/record_drain.h"

#include <atomic>
#include <deque>
#include <memory>
#include <mutex>
#include <vector>

namespace fathom::operate {

// The fixtures from change `number` on (PublishedFrame::edit).
struct KeptScene {
    uint64_t number = 0;
    std::string text; // of the scene file, without spare rows
    RecordedScene recorded;
};

// A frame and the ticks until the next one.
struct KeptFrame {
    PublishedFrame frame; // without set, grid and colour
    Pose baseTcamera;
    size_t pixels = 0, colourPixels = 0;
    std::vector<uint8_t> depth, colour; // packed (packed_image.h)
    std::vector<TickRow> ticks;
    std::vector<size_t> marks; // indices of marked ticks
    size_t bytes() const { return depth.size() + colour.size() + ticks.size() * sizeof(TickRow); }
};

// What is kept, in time order.
struct KeptPast {
    std::vector<std::shared_ptr<const KeptFrame>> frames;
    KeptScene first;              // the fixtures at the first frame
    std::vector<KeptScene> later; // and after
    double seconds() const;       // [s] from the first to the last frame
};

class LastSeconds final : public ForwardingSink {
public:
    static constexpr double kSpan = 30.0; // [s]
    // 1 GiB, or an eighth of the machine's memory if that is less [bytes].
    static size_t defaultMemory();

    // `next` outlives this. most: memory for frames and ticks [bytes]; the oldest are dropped first.
    // 0 keeps nothing. While no frame comes, the ticks after kSpan are not kept.
    LastSeconds(RunSink& next, size_t most)
        : ForwardingSink(next)
        , most_(most) {}

    // Window thread.
    void edit(KeptScene scene);
    void mark() { marked_.store(true); } // the next tick
    // The frames whose ticks are complete.
    KeptPast past() const;
    double seconds() const;
    size_t bytes() const;

    // Writer thread of the run.
    void frame(const PublishedFrame& frame, const HostFixtures& set) override;
    void step(const TickRow& row, const ObeyedSet& obeyed) override;

private:
    size_t totalBytes() const { return bytes_ + (open_ ? open_->bytes() : 0); } // [bytes]
    void forgetOld();

    const size_t most_;
    std::atomic<bool> marked_{false};
    mutable std::mutex mutex_; // guards all members below; window and writer thread
    std::deque<std::shared_ptr<const KeptFrame>> frames_;
    std::shared_ptr<KeptFrame> open_; // the newest frame, whose ticks still arrive
    std::deque<KeptScene> scenes_;    // the first is that of the first frame
    size_t bytes_ = 0;                // of frames_
};

class Recorder;
// Writes it into a recording, and waits for the recorder when it is busy. The recorder must record; returns
// early when it stops.
void feed(Recorder& recorder, const KeptPast& past);

} // namespace fathom::operate
