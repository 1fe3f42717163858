// SPDX-License-Identifier: Apache-2.0
// Threads that share the parts of a short job with their caller.
#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <thread>
#include <vector>

namespace fathom {

// For jobs of tens of microseconds and more on idle processors: after each wake() and each job, workers spin
// for a while before they sleep. They inherit the affinity of the thread that makes the pool, and block all
// signals. One thread calls everything.
class ThreadPool {
public:
    // workers: the caller counts as one; 1 = no thread is made. spinTime: how long idle workers spin.
    explicit ThreadPool(uint32_t workers, std::chrono::microseconds spinTime = std::chrono::milliseconds(1));
    ~ThreadPool();
    ThreadPool(const ThreadPool&) = delete;
    ThreadPool& operator=(const ThreadPool&) = delete;

    uint32_t size() const { return static_cast<uint32_t>(threads_.size()) + 1; }

    // Wakes sleeping workers before a job. Costs a system call.
    void wake() noexcept;

    // Runs job(part) once for each part 0 .. parts - 1, in any order, on any worker. Returns when all are
    // done; the caller then sees what they wrote. The job must not throw. parts < 65536.
    template <class Job>
    void run(uint32_t parts, const Job& job) noexcept {
        runWork(parts, {[](const void* it, uint32_t part) { (*static_cast<const Job*>(it))(part); }, &job});
    }

private:
    struct Work {
        void (*run)(const void*, uint32_t) = nullptr;
        const void* job = nullptr;
    };
    void end() noexcept;
    void runWork(uint32_t parts, const Work& work) noexcept;
    bool takePart() noexcept;
    void runWorker() noexcept;

    Work work_; // read only by workers that have claimed a part of it
    // Number of the job << 32 | parts << 16 | next part: one word, so that no worker claims a part of a
    // finished job.
    std::atomic<uint64_t> claims_{0};
    std::atomic<uint32_t> done_{0}, wakes_{0};
    std::atomic<bool> ending_{false};
    const std::chrono::microseconds spinTime_;
    std::vector<std::jthread> threads_;
};

// Number of parts, of at least `least` each, into which n items are split: up to four per worker, so that a
// late worker takes fewer; one part without a pool, even when n is 0.
inline uint32_t partsOf(const ThreadPool* workers, size_t n, size_t least) noexcept {
    const size_t most = workers == nullptr || workers->size() == 1 ? 1 : size_t{workers->size()} * 4;
    return static_cast<uint32_t>(std::clamp<size_t>(n / least, 1, most));
}

// Runs job(begin, end) on those parts.
template <class Job>
void inParts(ThreadPool* workers, size_t n, size_t least, const Job& job) noexcept {
    const size_t parts = partsOf(workers, n, least);
    if (parts < 2) {
        job(size_t{0}, n);
        return;
    }
    workers->run(static_cast<uint32_t>(parts),
                 [&](uint32_t part) { job(n * part / parts, n * (part + 1) / parts); });
}

} // namespace fathom
