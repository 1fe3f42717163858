// SPDX-License-Identifier: Apache-2.0
// Ctrl-C as a flag: while one lives, SIGINT and SIGTERM ask the run to end instead of ending the program.
#pragma once

#include <atomic>
#include <csignal>

namespace fathom {

// At most one at a time. The earlier dispositions return with its end.
class StopSignals {
public:
    StopSignals() noexcept;
    StopSignals(const StopSignals&) = delete;
    StopSignals& operator=(const StopSignals&) = delete;
    ~StopSignals();

    // Set by the first signal, cleared by the next StopSignals.
    const std::atomic<bool>& asked() const noexcept;

private:
    struct sigaction interrupt_ {};
    struct sigaction terminate_ {};
};

} // namespace fathom
