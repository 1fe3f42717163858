// SPDX-License-Identifier: Apache-2.0
// Waiting for a state, never for a time.
#pragma once

#include <chrono>
#include <thread>

namespace fathom::testing {

// Tests the condition every millisecond. True once it holds; false when it never did within `most`, which is
// more than a busy machine needs.
template <class Condition>
bool eventually(Condition&& condition, std::chrono::milliseconds most) {
    const auto end = std::chrono::steady_clock::now() + most;
    while (!condition()) {
        if (std::chrono::steady_clock::now() >= end) {
            return false;
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return true;
}

template <class Condition>
bool eventually(Condition&& condition, int seconds = 60) {
    return eventually(condition, std::chrono::milliseconds(1000 * seconds));
}

} // namespace fathom::testing
