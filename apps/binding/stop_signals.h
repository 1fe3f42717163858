// SPDX-License-Identifier: Apache-2.0
// Ctrl-C as a flag. While a StopSignals exists, SIGINT, SIGTERM, SIGQUIT and SIGHUP (terminal closed) request
// the end of the run instead of ending the program, so that the last wrench is zero. SIGPIPE (the reader of
// the output ended) is ignored.
#pragma once

#include <array>
#include <atomic>
#include <csignal>

namespace fathom {

// At most one at a time. The destructor restores the earlier dispositions. SIGHUP stays ignored if it was
// (nohup).
class StopSignals {
public:
    StopSignals() noexcept;
    StopSignals(const StopSignals&) = delete;
    StopSignals& operator=(const StopSignals&) = delete;
    ~StopSignals();

    // Set by the first signal, cleared by the next StopSignals.
    const std::atomic<bool>& requested() const noexcept;

private:
    static constexpr std::array kStopping{SIGINT, SIGTERM, SIGQUIT, SIGHUP};
    std::array<struct sigaction, kStopping.size()> before_{};
    struct sigaction beforePipe_ {};
};

} // namespace fathom
