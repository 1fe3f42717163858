// SPDX-License-Identifier: Apache-2.0
#include "apps/binding/run_observers.h"
#include "apps/operate/last_seconds.h"
#include "apps/operate/snapshots.h"
#include "apps/output/fault_trace.h"

#include <doctest/doctest.h>

using namespace fathom;

namespace {

struct CountingSink final : RunSink {
    int frames = 0, queries = 0, steps = 0;
    void frame(const PublishedFrame&, const HostFixtures&) override { ++frames; }
    void query(const QueryNote&) override { ++queries; }
    void step(const TickRow&, const ObeyedSet&) override { ++steps; }
};

} // namespace

TEST_CASE("The chain of sinks of a window passes on frames, queries and steps") {
    CountingSink end;
    operate::LastSeconds last(end, 0);
    RunObservers observers({}, nullptr);
    PublishedSink published(last, observers);
    FaultTrace faults("", 0.001, published);
    operate::SnapshotSink first(faults);
    const HostFixtures set{};
    first.frame(PublishedFrame(), set);
    first.query(QueryNote());
    first.step(TickRow(), {});
    CHECK(end.frames == 1);
    CHECK(end.queries == 1);
    CHECK(end.steps == 1);
}
