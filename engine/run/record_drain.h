// SPDX-License-Identifier: Apache-2.0
// The writer's side of the channels: sorts steps, queries and frames into an order that can be audited.
#pragma once

#include "engine/run/channels.h"

#include <deque>
#include <optional>
#include <span>

namespace fathom {

// What a step obeyed. Valid during the call that passes it on.
struct ObeyedSet {
    const PublishedFrame* frame = nullptr; // whose set it was; null = none, or it is no longer kept
    bool known = false;                    // false: the set or the query's answer is no longer kept
    std::span<const uint32_t> behind;      // leaves behind a surface in that answer
};

// Receives the records of a run. Called on the writer thread; may allocate, block and throw.
class RunSink {
public:
    virtual ~RunSink() = default;
    // A processed frame. `set` is the newest set from this frame on; frame.fixtures may be empty for a
    // repeated frame.
    virtual void frame(const PublishedFrame& frame, const HostFixtures& set) = 0;
    virtual void query(const QueryNote& note) = 0;
    virtual void step(const TickRow& row, const ObeyedSet& obeyed) = 0;
};

// A sink of a chain. Passes everything on; derived classes override what they watch.
class ForwardingSink : public RunSink {
public:
    // `next` outlives this.
    explicit ForwardingSink(RunSink& next)
        : next_(next) {}
    void frame(const PublishedFrame& frame, const HostFixtures& set) override { next_.frame(frame, set); }
    void query(const QueryNote& note) override { next_.query(note); }
    void step(const TickRow& row, const ObeyedSet& obeyed) override { next_.step(row, obeyed); }

private:
    RunSink& next_;
};

// Writer thread only. Keeps host copies of published sets while a step may obey them.
class RecordDrain {
public:
    RecordDrain(Channels& channels, RunSink& sink)
        : channels_(channels)
        , sink_(sink) {}

    // Passes on everything that has arrived. A step whose set has not arrived yet waits, unless `all`.
    void drain(bool all = false);

    const PublishedFrame* newest() const { return kept_.empty() ? nullptr : kept_.back(); }
    uint64_t frames() const { return frames_; }

private:
    void takeFrames();
    void takeQueries();
    void pass(const TickRow& row);
    ObeyedSet obeyedBy(const TickRow& row) const;
    void giveBack(size_t i);

    static constexpr size_t kKept =
        Channels::kFramesInFlight * 3 / 4; // so that the frame thread always finds a free frame

    Channels& channels_;
    RunSink& sink_;
    std::deque<PublishedFrame*> kept_; // by generation, from the one before the obeyed one on
    std::deque<QueryNote> notes_;      // by query; the front is the one that the last step obeyed
    std::optional<TickRow> waiting_;
    uint64_t newestGeneration_ = 0;
    uint64_t frames_ = 0;
};

} // namespace fathom
