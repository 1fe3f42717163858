// SPDX-License-Identifier: Apache-2.0
// The deciding step of every contact query. A query may list too many pairs of region sphere and leaf, but
// never too few, and may leave pairs undecided. Whatever float32 cannot tell, float64 arithmetic on the host
// decides. So contact sets do not depend on which device listed the pairs.
#pragma once

#include "engine/contact/contact_set.h"
#include "engine/contact/source_sort.h"

#include <cstdint>
#include <glm/vec4.hpp>
#include <span>
#include <vector>

namespace fathom {

// [m] By how much a gap computed in float32 may be wrong, with a margin for its band
// (docs/architecture/query.md has the proof). Positions may be about the set's origin or in the tool's frame.
// toolRadius: Tool::boundingRadius(). away: distance of the tool's frame from the set's origin. largest:
// largest radius of the spheres. All in metres.
float searchError(double toolRadius, double away, double reach, double largest) noexcept;

// A float32 search must find every pair within `reach`. It does if it tests
//     dx dx + dy dy + dz dz <= (outward + r + R)^2
// in float32 with any rounding, where `outward` is the result.
float outwardReach(double toolRadius, double away, double reach, double largest) noexcept;

// A region sphere with some of the leaves that may be near it.
struct NearSphere {
    uint32_t source, fixture;
    uint32_t first, count; // its leaves: NearPairs::buckets[first .. first + count)
    float x, y, z, radius; // [m] about the set's origin
};

// In any order. A sphere may occur several times, each time with other leaves.
struct NearPairs {
    static constexpr uint32_t kUndecided = 0x80000000u;

    std::vector<NearSphere> spheres;
    // As ListedPairs::bucket. With kUndecided the band is open, and so is whether the pair is in the set. In
    // memory of the query that listed the pairs, until its next list.
    std::span<const uint32_t> buckets;
};

// Pairs that are in the set.
struct ListedPairs {
    std::vector<uint32_t> bucket; // leaf x ContactSet::kGapBands + band of the gap
    std::vector<uint32_t> sphere; // index in the set

    size_t size() const { return bucket.size(); }
    void clear() {
        bucket.clear();
        sphere.clear();
    }
    void resize(size_t n) {
        bucket.resize(n);
        sphere.resize(n);
    }
};

// Scratch of decidePairs() and placePairs(), kept to save allocations. One thread.
struct DecideScratch {
    ListedPairs pairs;
    std::vector<uint32_t> order, next;
    std::vector<glm::vec4> spheres; // of the set: centre and radius
    SourceSort sort;
};

// Replaces the spheres and pairs of `set`: every pair whose gap at the query pose, in
// float64, is at most set.reach (plus 1 nm of margin), and every sphere with such a pair. False, with an
// incomplete set, when there are more than `mostPairs`.
bool decidePairs(const Tool& tool, const NearPairs& near, size_t mostPairs, DecideScratch& scratch,
                 ContactSet& set);

// Fills the pair arrays of `set` from pairs in the order of the set's spheres: by leaf, then band, then
// source.
void placePairs(const ListedPairs& pairs, DecideScratch& scratch, ContactSet& set);

inline constexpr double kPairMargin = 1e-9; // [m] by which listed gaps may exceed the reach

} // namespace fathom
