// SPDX-License-Identifier: Apache-2.0
#include "apps/operate/snapshots.h"

namespace fathom::operate {

void SnapshotSink::frame(const PublishedFrame& frame, const HostFixtures& set) {
    SceneSnapshot& out = scene_.back();
    out.any = true;
    out.report = frame.report;
    out.t = frame.t;
    out.set = set;
    out.colour = frame.colour;
    out.number = ++frames_;
    scene_.publish();
    ForwardingSink::frame(frame, set);
}

void SnapshotSink::step(const TickRow& row, const ObeyedSet& obeyed) {
    ticks_.push(row);
    ForwardingSink::step(row, obeyed);
}

} // namespace fathom::operate
