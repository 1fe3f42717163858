// SPDX-License-Identifier: Apache-2.0
#include "apps/binding/stop_signals.h"

namespace fathom {

namespace {

std::atomic<bool> stopAsked{false}; // a signal handler is given nothing: its flag can only live here
static_assert(std::atomic<bool>::is_always_lock_free);

extern "C" void fathomAskStop(int) {
    stopAsked.store(true);
}

} // namespace

StopSignals::StopSignals() noexcept {
    stopAsked.store(false);
    struct sigaction action {};
    action.sa_handler = &fathomAskStop;
    action.sa_flags = SA_RESTART;
    ::sigemptyset(&action.sa_mask);
    ::sigaction(SIGINT, &action, &interrupt_);
    ::sigaction(SIGTERM, &action, &terminate_);
}

StopSignals::~StopSignals() {
    ::sigaction(SIGINT, &interrupt_, nullptr);
    ::sigaction(SIGTERM, &terminate_, nullptr);
}

const std::atomic<bool>& StopSignals::asked() const noexcept {
    return stopAsked;
}

} // namespace fathom
