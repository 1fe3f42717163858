// SPDX-License-Identifier: Apache-2.0
#include "apps/binding/stop_signals.h"

namespace fathom {

namespace {

std::atomic<bool> stopRequested{false}; // global, because a signal handler gets no context
static_assert(std::atomic<bool>::is_always_lock_free);

extern "C" void fathomRequestStop(int) {
    stopRequested.store(true);
}

} // namespace

StopSignals::StopSignals() noexcept {
    stopRequested.store(false);
    struct sigaction action {};
    action.sa_handler = &fathomRequestStop;
    action.sa_flags = SA_RESTART;
    ::sigemptyset(&action.sa_mask);
    for (size_t i = 0; i < kStopping.size(); ++i) {
        ::sigaction(kStopping[i], nullptr, &before_[i]);
        if (kStopping[i] != SIGHUP || before_[i].sa_handler != SIG_IGN) {
            ::sigaction(kStopping[i], &action, nullptr);
        }
    }
    action.sa_handler = SIG_IGN;
    ::sigaction(SIGPIPE, &action, &beforePipe_);
}

StopSignals::~StopSignals() {
    for (size_t i = 0; i < kStopping.size(); ++i) {
        ::sigaction(kStopping[i], &before_[i], nullptr);
    }
    ::sigaction(SIGPIPE, &beforePipe_, nullptr);
}

const std::atomic<bool>& StopSignals::requested() const noexcept {
    return stopRequested;
}

} // namespace fathom
