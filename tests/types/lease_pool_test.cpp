// SPDX-License-Identifier: Apache-2.0
#include "engine/types/lease_pool.h"

#include <array>
#include <atomic>
#include <doctest/doctest.h>
#include <thread>
#include <vector>

using namespace fathom;

namespace {

struct Value {
    std::array<uint64_t, 64> words{};
};

auto makePool(uint32_t readers) {
    return LeasePool<Value>(readers, [] { return std::make_unique<Value>(); });
}

} // namespace

TEST_CASE("A pool has nothing to lease before the first publish") {
    auto pool = makePool(1);
    CHECK_FALSE(pool.newest());
}

TEST_CASE("A leased value is never written while newer ones are published") {
    auto pool = makePool(1);
    pool.back().words.fill(1);
    pool.publish();
    const auto lease = pool.newest();
    for (uint64_t n = 2; n < 20; ++n) {
        pool.back().words.fill(n);
        pool.publish();
    }
    CHECK(lease->words[0] == 1);
    CHECK(lease->words[63] == 1);
    CHECK(pool.newest()->words[0] == 19);
}

TEST_CASE("Two readers under a writer never see a torn value and never an older one") {
    auto pool = makePool(2);
    constexpr uint64_t kCount = 50000;
    std::atomic<uint64_t> torn{0}, older{0};
    const auto read = [&] {
        uint64_t last = 0;
        while (last < kCount) {
            const auto lease = pool.newest();
            if (!lease) {
                continue;
            }
            const uint64_t first = lease->words[0];
            for (uint64_t word : lease->words) {
                torn += word != first; // counts torn reads; must stay zero
            }
            older += first < last;
            last = first;
        }
    };
    std::thread a(read), b(read);
    for (uint64_t n = 1; n <= kCount; ++n) {
        pool.back().words.fill(n);
        pool.publish();
    }
    a.join();
    b.join();
    CHECK(torn == 0);
    CHECK(older == 0);
}
