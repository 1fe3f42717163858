// SPDX-License-Identifier: Apache-2.0
// The writer's end of the crossings: brings turns, queries and frames together again, in an order that can be
// audited.
#pragma once

#include "apps/binding/crossings.h"

#include <deque>
#include <optional>
#include <span>

namespace fathom {

// What becomes of a run's records. Called on the writer thread; may allocate, block and throw.
class RunSink {
public:
    virtual ~RunSink() = default;
    // A used frame; frame.fixtures may be empty when the picture was the same again: `set` is the one in
    // force from it on.
    virtual void frame(const PublishedFrame& frame, const Fixtures& set) = 0;
    virtual void query(const QueryNote& note) = 0;
    // `obeyed`: the frame whose set the turn obeyed, null when there is none or it is no longer kept
    // (obeyedKnown false). `behind`: the leaves flagged in the answer it obeyed.
    virtual void step(const TickRow& row, const PublishedFrame* obeyed, bool obeyedKnown,
                      std::span<const uint32_t> behind) = 0;
};

// One thread. Keeps host copies of published sets until no turn obeys them any more.
class RecordDrain {
public:
    RecordDrain(Crossings& crossings, RunSink& sink)
        : crossings_(crossings)
        , sink_(sink) {}

    // Hands over all that has come. A turn whose set has not arrived yet waits, unless `all`.
    void drain(bool all = false);

    const PublishedFrame* newest() const { return kept_.empty() ? nullptr : kept_.back(); }
    uint64_t ticks() const { return ticks_; }
    uint64_t frames() const { return frames_; }

private:
    void takeFrames();
    void takeQueries();
    void hand(const TickRow& row);
    void letGo(size_t i);

    static constexpr size_t kKept =
        Crossings::kFramesInFlight * 3 / 4; // the frame cadence always finds one to fill

    Crossings& crossings_;
    RunSink& sink_;
    std::deque<PublishedFrame*> kept_; // by generation
    std::deque<QueryNote> notes_;      // by query; the front is the one obeyed
    std::optional<TickRow> waiting_;
    uint64_t newestGeneration_ = 0;
    uint64_t ticks_ = 0, frames_ = 0;
};

} // namespace fathom
