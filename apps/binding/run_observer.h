// SPDX-License-Identifier: Apache-2.0
// A receiver of the state of a realtime run, outside of this process.
#pragma once

#include "apps/binding/remote_requests.h"
#include "engine/run/channels.h"

#include <span>

namespace fathom {

// Writer thread, except setShapes() and forget().
class RunObserver {
public:
    virtual ~RunObserver() = default;
    virtual void step(const TickRow& row) = 0;
    // `set` must stay valid until the next call, because an observer that connects later receives it.
    virtual void frame(const HostFixtures& set) = 0;
    // Active from now on. Any thread; waits while the writer copies them.
    virtual void setShapes(std::span<const Shape> shapes) = 0;
    // Drops the last set. Call it only while no run is active.
    virtual void forget() noexcept = 0;
    // What it has asked for since the last call. Any thread.
    virtual RemoteRequests takeRequests() { return {}; }
};

} // namespace fathom
