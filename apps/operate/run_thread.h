// SPDX-License-Identifier: Apache-2.0
// A thread for runs one after another: each run starts with resume() and ends with pause() or by itself.
#pragma once

#include <atomic>
#include <exception>
#include <functional>
#include <semaphore>
#include <thread>

namespace fathom::operate {

// One thread calls everything; any thread may call ended(). The thread lives as long as this, so that threads
// which a later run makes inherit the priority of the first.
class RunThread {
public:
    // body: one run, until `stop` is set; returns what made it fail, null = nothing.
    explicit RunThread(std::function<std::exception_ptr(const std::atomic<bool>& stop)> body);
    ~RunThread() { end(); }

    void resume();
    void pause(); // returns when the run has ended
    void end();   // pauses, then ends the thread

    bool ended() const { return ended_.load(); } // by itself, or by a failure
    std::exception_ptr failure() const { return failure_; }

private:
    void loop();

    std::function<std::exception_ptr(const std::atomic<bool>& stop)> body_;
    std::atomic<bool> stop_{false}, ended_{false};
    std::binary_semaphore go_{0}, done_{0};
    bool running_ = false, over_ = false; // over_: read after go_
    std::exception_ptr failure_;
    std::thread thread_;
};

} // namespace fathom::operate
