// SPDX-License-Identifier: Apache-2.0
// Repeats a query, on the CPU or the GPU, with a smaller reach until its result fits. So every contact set is
// complete within the reach that it states.
#pragma once

#include "engine/contact/contact_set.h"
#include "engine/types/error.h"

#include <algorithm>
#include <cstdint>
#include <string>

namespace fathom {

// Counts since construction.
struct QueryStatistics {
    uint64_t queries = 0;
    uint64_t overflows = 0;  // queries that had to shrink their reach
    uint64_t spheresMax = 0; // most spheres in one result
    uint64_t pairsMax = 0;
};

// Capacity of a result. A query that overflows doubles both for the next one.
struct QueryCapacity {
    size_t spheres = 65536;
    size_t pairs = 262144;
};

// One thread, contact cadence: allocates.
class QueryLoop {
public:
    explicit QueryLoop(const QueryCapacity& capacity = {})
        : capacity_(capacity) {}

    // list(reach, capacity, out) fills `out` with every pair within the reach, and returns false when there
    // are more than the capacity. Then the reach is halved until they fit, and out.reach states it. When even
    // the touching spheres do not fit, the capacity is raised at once, so no sphere is ever dropped.
    // ContactSet::behind stays empty.
    template <class List>
    void run(double reach, List&& list, ContactSet& out) {
        bool overflowed = false;
        QueryCapacity next = capacity_;
        for (double tried = reach;;) {
            if (list(tried, capacity_, out) && out.size() <= capacity_.spheres) {
                break;
            }
            const QueryCapacity doubled{2 * capacity_.spheres, std::min(2 * capacity_.pairs, kMaxPairs)};
            next = overflowed ? next : doubled;
            overflowed = true;
            if (tried > kSmallestReach) {
                tried *= 0.5;
            } else if (capacity_.pairs < kMaxPairs || out.size() > capacity_.spheres) {
                capacity_ = next = doubled;
            } else {
                throw Error("the tool's " + std::to_string(out.leafCount()) +
                            " leaf spheres touch more than " + std::to_string(kMaxPairs) +
                            " pairs of leaf and region sphere (allowed: a tool "
                            "with fewer or smaller spheres, or one that starts outside of the regions)");
            }
        }
        capacity_ = next;
        finish(overflowed, out);
    }

    const QueryStatistics& statistics() const { return statistics_; }
    const QueryCapacity& capacity() const { return capacity_; }

private:
    // 38 MB per set; with 1.6 million pairs a tick took 0.26 s
    static constexpr size_t kMaxPairs = size_t{1} << 20;
    // [m] below this the trust region is only margin, so halving gains nothing
    static constexpr double kSmallestReach = 2e-5;

    void finish(bool overflowed, ContactSet& out) {
        statistics_.overflows += overflowed ? 1 : 0;
        ++statistics_.queries;
        statistics_.spheresMax = std::max<uint64_t>(statistics_.spheresMax, out.size());
        statistics_.pairsMax = std::max<uint64_t>(statistics_.pairsMax, out.pairSphere.size());
        out.query = statistics_.queries;
    }

    QueryCapacity capacity_;
    QueryStatistics statistics_;
};

} // namespace fathom
