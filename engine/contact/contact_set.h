// SPDX-License-Identifier: Apache-2.0
// Contact set: every region sphere whose gap to some tool leaf is at most `reach`, with the fixture set and
// pose of the query.
#pragma once

#include "engine/contact/host_fixtures.h"
#include "engine/contact/leaf_centres.h"
#include "engine/contact/tool.h"

#include <cstdint>
#include <limits>
#include <vector>

namespace fathom {

// Spheres are sorted by source. Listed pairs are grouped by leaf: pairs of leaf i are pairSphere[pairBegin[i]
// .. pairBegin[i + 1]), each an index into the spheres; a pair is listed when its gap at the query pose is <=
// reach. While every leaf centre stays within reach of its position at the query, no unlisted pair can touch.
// That is the trust region. Axes of the base frame, about the origin; float64 copies of the fixture set's
// floats.
struct ContactSet {
    // Pairs of a leaf are stored in bands of their gap at the query: gaps below reach / 16 first, then one
    // band per further 16th. Near the query pose the haptic step thus reads only the pairs that matter.
    static constexpr uint32_t kGapBands = 16;

    int64_t frame = -1;                                        // its fixture set; -1 = none yet
    uint64_t generation = 0;                                   // of that fixture set
    double captureTime = 0.0;                                  // [s] of that fixture set
    uint64_t query = 0;                                        // counts answered queries
    double askedAt = std::numeric_limits<double>::quiet_NaN(); // [s] of the step that asked; NaN: none
    double reach = 0.0;                                        // [m] the set is complete within
    dvec3 origin{0.0};                                         // [m] base frame: origin of all positions here
    dvec3 camera{0.0}; // [m] camera centre of that fixture set, about the origin

    std::vector<double> x, y, z, radius; // spheres, about the origin [m]
    std::vector<uint32_t> source;        // RegionSpheres::source
    std::vector<uint8_t> fixture;        // index into Scene::fixtures
    std::vector<uint32_t> pairBegin;     // leafCount + 1
    std::vector<uint32_t> pairSphere;    // by band within a leaf, by source within a band
    std::vector<uint32_t> pairBandEnd;   // leafCount x kGapBands: where the pairs of bands 0..b of a leaf end
    LeafCentres leafAtQuery;             // leaf centres at the query pose, about the origin [m]
    // The same sphere values again in pair order, so that kernels read them contiguously.
    std::vector<float> pairX, pairY, pairZ, pairRadius;

    // Leaves that new data put on the far side of a surface (BehindTracker), and how to leave it.
    struct Behind {
        uint32_t leaf;
        dvec3 towardsCamera; // unit, base axes
        double distance;     // [m] left in that direction until the leaf is clear in front of the surface
    };
    std::vector<Behind> behind; // by leaf

    // Clears spheres, pairs and flags; keeps the memory and all other fields.
    void clear() noexcept;
    // Writes the leaves of `behind` to `out`, whose memory it reuses.
    void leavesBehind(std::vector<uint32_t>& out) const;
    size_t size() const { return x.size(); }
    size_t leafCount() const { return leafAtQuery.size(); }

    // Band of a gap at the query [m]; monotone, so every pair with gap <= g is in the bands 0..bandOf(g).
    uint32_t bandOf(double gap) const noexcept {
        const double band = gap * (kGapBands / reach);
        if (!(band > 0.0)) { // touching, or NaN where reach is 0
            return 0;
        }
        return band >= kGapBands ? kGapBands - 1 : static_cast<uint32_t>(band);
    }
    // End of the run of pairs of `leaf` that contains every pair whose gap at the query is <= g [m]. It may
    // contain more.
    uint32_t pairsUpTo(size_t leaf, double g) const noexcept {
        return pairBandEnd[leaf * kGapBands + bandOf(g)];
    }
};

} // namespace fathom
