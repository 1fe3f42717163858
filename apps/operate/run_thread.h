// SPDX-License-Identifier: Apache-2.0
// A thread that runs one run after another: each starts with resume() and ends with pause() or by itself.
#pragma once

#include <atomic>
#include <exception>
#include <functional>
#include <semaphore>
#include <thread>

namespace fathom::operate {

// One thread calls everything; any thread may call ended(). The thread lives as long as this object, so that
// threads created by a later run inherit the priority of the first.
class RunThread {
public:
    // body: one run, until `stop` is set. Returns its failure, null = none.
    explicit RunThread(std::function<std::exception_ptr(const std::atomic<bool>& stop)> body);
    ~RunThread() { end(); }

    void resume();
    void pause(); // returns when the run has ended
    void end();   // pauses, then ends the thread

    bool ended() const { return ended_.load(); } // the run ended by itself or failed
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
