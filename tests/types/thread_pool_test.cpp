// SPDX-License-Identifier: Apache-2.0
// Jobs shared by threads; also run under the thread sanitizer.
#include "engine/types/thread_pool.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <doctest/doctest.h>

using namespace fathom;

TEST_CASE("Each part of a job runs once, and its results are visible when the job is over") {
    for (const uint32_t members : {1u, 2u, 3u}) {
        CAPTURE(members);
        ThreadPool workers(members);
        CHECK(workers.size() == members);
        size_t wrong = 0;
        for (uint32_t round = 0; round < 400; ++round) {
            const uint32_t parts = round % 23; // none, one, more than workers
            std::vector<uint32_t> times(parts, 0);
            if (round % 3 == 0) {
                workers.wake();
            }
            workers.run(parts, [&](uint32_t part) { times[part] += part + 1; });
            for (uint32_t part = 0; part < parts; ++part) {
                wrong += times[part] != part + 1;
            }
        }
        CHECK(wrong == 0);
    }
}

TEST_CASE("Sleeping workers are woken by wake(), and a job does not need them") {
    ThreadPool workers(3);
    std::this_thread::sleep_for(std::chrono::milliseconds(20)); // longer than the spin time
    std::vector<std::thread::id> by(64);
    const auto job = [&](uint32_t part) {
        by[part] = std::this_thread::get_id();
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
    };
    const auto others = [&] {
        return std::ranges::any_of(by, [](std::thread::id id) { return id != std::this_thread::get_id(); });
    };
    bool shared = false; // eventually, however busy the machine is
    for (int round = 0; round < 20 && !shared; ++round) {
        workers.wake();
        workers.run(static_cast<uint32_t>(by.size()), job);
        CHECK(std::ranges::count(by, std::thread::id()) == 0);
        shared = others();
    }
    CHECK(shared);
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    std::ranges::fill(by, std::thread::id());
    workers.run(static_cast<uint32_t>(by.size()),
                [&](uint32_t part) { by[part] = std::this_thread::get_id(); });
    CHECK(std::ranges::count(by, std::thread::id()) == 0);
}

TEST_CASE("Workers block the signals of the program, and the maker of the pool keeps its own") {
    const auto blocks = [](int signal) {
        sigset_t mask;
        ::pthread_sigmask(SIG_BLOCK, nullptr, &mask);
        return ::sigismember(&mask, signal) == 1;
    };
    const bool before = blocks(SIGTERM);
    ThreadPool workers(3);
    CHECK(blocks(SIGTERM) == before);
    std::atomic<int> taken{0}, open{0}, deaf{0};
    for (int round = 0; round < 20 && taken == 0; ++round) { // until a worker takes part
        workers.run(16, [&, caller = std::this_thread::get_id()](uint32_t) {
            if (std::this_thread::get_id() != caller) {
                ++taken;
                open += blocks(SIGTERM) ? 0 : 1;
                deaf += blocks(SIGSEGV) ? 1 : 0;
            }
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        });
    }
    CHECK(taken > 0);
    CHECK(open == 0);
    CHECK(deaf == 0);
}

TEST_CASE("The end of a thread pool does not hang, whatever its workers are doing") {
    for (int round = 0; round < 3000; ++round) {
        ThreadPool workers(3, std::chrono::microseconds(0));
        if (round % 2 == 0) {
            workers.run(3, [](uint32_t) {});
        }
    }
}

TEST_CASE("Parts of n items cover each item once and are never smaller than requested") {
    ThreadPool workers(2);
    for (ThreadPool* who : {static_cast<ThreadPool*>(nullptr), &workers}) {
        for (const size_t n : {0u, 1u, 9u, 10u, 19u, 20u, 1000u, 1003u}) {
            CAPTURE(n);
            std::vector<uint8_t> times(n, 0);
            std::atomic<size_t> smallest = n, parts = 0;
            inParts(who, n, 10, [&](size_t begin, size_t end) {
                std::for_each(times.begin() + static_cast<long>(begin),
                              times.begin() + static_cast<long>(end), [](uint8_t& t) { ++t; });
                ++parts;
                for (size_t least = smallest; end - begin < least;) {
                    smallest.compare_exchange_weak(least, end - begin);
                }
            });
            CHECK(std::ranges::count(times, 1) == static_cast<long>(n));
            CHECK(smallest >= std::min<size_t>(n, 10));
            CHECK(parts == (who == nullptr ? 1 : std::clamp<size_t>(n / 10, 1, 8)));
        }
    }
}
