// SPDX-License-Identifier: Apache-2.0
#include "engine/types/lease_pool.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <doctest/doctest.h>
#include <thread>

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

TEST_CASE("A value's place in its pool is found, and a value of another pool has none") {
    auto pool = makePool(1), other = makePool(1);
    for (size_t i = 0; i < pool.size(); ++i) {
        CHECK(pool.indexOf(pool.at(i)) == i);
    }
    CHECK_THROWS_AS(pool.indexOf(other.at(0)), std::logic_error);
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

TEST_CASE("A value that is published early is leased by early readers only, until it is complete") {
    auto pool = makePool(2);
    pool.back().words.fill(1);
    pool.publishEarly();
    CHECK_FALSE(pool.newest());
    CHECK(pool.newestEarly()->words[0] == 1);
    pool.back().words[63] = 2; // still the same value
    pool.publish();
    CHECK(pool.newest()->words[63] == 2);
    pool.back().words.fill(3);
    const auto complete = pool.newest(), before = pool.newestEarly();
    pool.publishEarly();
    CHECK(pool.newest()->words[0] == 1);
    {
        const auto early = pool.newestEarly();
        CHECK(early->words[0] == 3);
        pool.back().words[63] = 4;
        pool.publish();
        CHECK(early->words[63] == 4);
    }
    CHECK(before->words[0] == 1);
    for (uint64_t n = 5; n < 20; ++n) { // leased values are not reused
        pool.back().words.fill(n);
        pool.publishEarly();
        pool.publish();
    }
    CHECK(complete->words[63] == 2);
    CHECK(pool.newest()->words[0] == 19);
}

TEST_CASE("A reader of complete values never sees one that is published early, and none reads a torn one") {
    auto pool = makePool(2);
    constexpr uint64_t kCount = 50000, kEarly = 32; // early readers read the first words
    std::atomic<uint64_t> torn{0}, older{0};
    const auto read = [&](auto newest, size_t words) {
        for (uint64_t last = 0; last < kCount;) {
            const auto lease = (pool.*newest)();
            if (!lease) {
                continue;
            }
            const uint64_t first = lease->words[0];
            for (size_t i = 0; i < words; ++i) {
                torn += lease->words[i] != first;
            }
            older += first < last;
            last = first;
        }
    };
    using Pool = LeasePool<Value>;
    std::thread early(read, &Pool::newestEarly, kEarly), complete(read, &Pool::newest, 64);
    for (uint64_t n = 1; n <= kCount; ++n) {
        std::fill_n(pool.back().words.begin(), kEarly, n);
        pool.publishEarly();
        std::fill(pool.back().words.begin() + kEarly, pool.back().words.end(), n);
        pool.publish();
    }
    early.join();
    complete.join();
    CHECK(torn == 0);
    CHECK(older == 0);
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
