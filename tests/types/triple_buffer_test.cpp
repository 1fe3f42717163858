// SPDX-License-Identifier: Apache-2.0
#include "engine/types/spsc_queue.h"
#include "engine/types/triple_buffer.h"

#include <array>
#include <doctest/doctest.h>
#include <thread>

using namespace fathom;

TEST_CASE("A triple buffer passes on the newest value and only once") {
    TripleBuffer<int> box(7);
    CHECK(box.front() == 7);
    CHECK_FALSE(box.refresh());
    box.back() = 1;
    box.publish();
    box.back() = 2;
    box.publish();
    CHECK(box.refresh());
    CHECK(box.front() == 2);
    CHECK_FALSE(box.refresh());
}

TEST_CASE("A triple buffer under two threads never shows a torn or an older value") {
    struct Value {
        std::array<uint64_t, 32> words{};
    };
    TripleBuffer<Value> box;
    constexpr uint64_t kCount = 200000;
    std::thread writer([&] {
        for (uint64_t n = 1; n <= kCount; ++n) {
            box.back().words.fill(n);
            box.publish();
        }
    });
    uint64_t last = 0, torn = 0, older = 0;
    while (last < kCount) {
        if (!box.refresh()) {
            std::this_thread::yield();
            continue;
        }
        const Value& v = box.front();
        for (uint64_t word : v.words) {
            torn += word != v.words[0];
        }
        older += v.words[0] <= last;
        last = v.words[0];
    }
    writer.join();
    CHECK(torn == 0);
    CHECK(older == 0);
}

TEST_CASE("A queue keeps the order and counts the values that a full queue dropped") {
    SpscQueue<int> ring(3); // rounded up to 4
    for (int i = 0; i < 6; ++i) {
        CHECK(ring.push(i) == (i < 4));
    }
    CHECK(ring.dropped() == 2);
    int value = -1;
    for (int i = 0; i < 4; ++i) {
        CHECK(ring.pop(value));
        CHECK(value == i);
    }
    CHECK_FALSE(ring.pop(value));
}

TEST_CASE("A queue under two threads delivers every accepted value in order") {
    SpscQueue<uint64_t> ring(64);
    constexpr uint64_t kCount = 200000;
    std::thread writer([&] {
        for (uint64_t n = 0; n < kCount;) {
            if (ring.push(n)) {
                ++n;
            } else {
                std::this_thread::yield();
            }
        }
    });
    uint64_t expected = 0, wrong = 0, value = 0;
    while (expected < kCount) {
        if (ring.pop(value)) {
            wrong += value != expected++;
        } else {
            std::this_thread::yield();
        }
    }
    writer.join();
    CHECK(wrong == 0);
}
