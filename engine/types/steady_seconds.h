// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>

namespace fathom {

// The monotonic clock [s], from a start that is the same for all processes of a machine. Any thread.
inline double steadySeconds() noexcept {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

} // namespace fathom
