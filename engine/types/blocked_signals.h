// SPDX-License-Identifier: Apache-2.0
// Keeps the program's signals away from the engine's threads.
#pragma once

#include <csignal>
#include <pthread.h>

namespace fathom {

// Blocks the calling thread's signals; the destructor restores them. Threads inherit the mask of the thread
// that starts them: started meanwhile, they run no handler of the program, and a signal that the program
// blocks for a signalfd waits there. Signals of faults stay, for crash reporters, and SIGPROF for profilers.
class BlockedSignals {
public:
    BlockedSignals() noexcept {
        sigset_t most;
        ::sigfillset(&most);
        for (const int fault : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGTRAP, SIGSYS, SIGABRT, SIGPROF}) {
            ::sigdelset(&most, fault);
        }
        ::pthread_sigmask(SIG_BLOCK, &most, &before_);
    }
    ~BlockedSignals() { ::pthread_sigmask(SIG_SETMASK, &before_, nullptr); }
    BlockedSignals(const BlockedSignals&) = delete;
    BlockedSignals& operator=(const BlockedSignals&) = delete;

private:
    sigset_t before_;
};

} // namespace fathom
