// SPDX-License-Identifier: Apache-2.0
// Requests from other programs to a run.
#pragma once

#include <optional>

namespace fathom {

// Since the last time. Forces can only be switched off from afar.
struct RemoteRequests {
    bool forcesOff = false;
    std::optional<bool> guidance, frozen; // frozen: all fixtures
};

} // namespace fathom
