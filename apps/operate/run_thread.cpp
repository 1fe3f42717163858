// SPDX-License-Identifier: Apache-2.0
#include "apps/operate/run_thread.h"

#include <utility>

namespace fathom::operate {

RunThread::RunThread(std::function<std::exception_ptr(const std::atomic<bool>& stop)> body)
    : body_(std::move(body))
    , thread_([this] { loop(); }) {}

void RunThread::loop() {
    for (go_.acquire(); !over_; go_.acquire()) {
        try {
            failure_ = body_(stop_);
        } catch (...) {
            failure_ = std::current_exception();
        }
        ended_.store(failure_ != nullptr || !stop_.load());
        done_.release();
    }
}

void RunThread::resume() {
    stop_.store(false);
    running_ = true;
    go_.release();
}

void RunThread::pause() {
    stop_.store(true);
    if (running_) {
        done_.acquire();
        running_ = false;
    }
}

void RunThread::end() {
    pause();
    if (thread_.joinable()) {
        over_ = true;
        go_.release();
        thread_.join();
    }
}

} // namespace fathom::operate
