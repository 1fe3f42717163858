// SPDX-License-Identifier: Apache-2.0
// The display's end of the copies that the frame thread and the haptic thread publish.
#pragma once

#include "engine/front/port_state.h"

namespace fathom::front {

// Frame thread: all of `out` except the stamp. Reuses its memory.
void fill(v0::Regions& out, const HostFixtures& set);

} // namespace fathom::front

namespace fathom::v0 {

// Display thread only.
struct ObserverPort::Impl {
    explicit Impl(std::shared_ptr<front::PortState> from)
        : shared(std::move(from)) {}
    std::shared_ptr<front::PortState> shared;
    bool pending = false; // newer regions were not copied yet, because memory was exhausted
};

} // namespace fathom::v0
