// SPDX-License-Identifier: Apache-2.0
// Ctrl-C as a flag: while one lives, SIGINT, SIGTERM, SIGQUIT and SIGHUP (the terminal closed) ask the run to
// end instead of ending the program, so that the last thing a hand feels is zero force. SIGPIPE, a reader of
// the output that went away, is no reason to end.
#pragma once

#include <array>
#include <atomic>
#include <csignal>

namespace fathom {

// At most one at a time. The earlier dispositions return with its end. SIGHUP stays ignored where it was
// (nohup).
class StopSignals {
public:
    StopSignals() noexcept;
    StopSignals(const StopSignals&) = delete;
    StopSignals& operator=(const StopSignals&) = delete;
    ~StopSignals();

    // Set by the first signal, cleared by the next StopSignals.
    const std::atomic<bool>& asked() const noexcept;

private:
    static constexpr std::array kStopping{SIGINT, SIGTERM, SIGQUIT, SIGHUP};
    std::array<struct sigaction, kStopping.size()> before_{};
    struct sigaction beforePipe_ {};
};

} // namespace fathom
