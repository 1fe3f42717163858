// SPDX-License-Identifier: Apache-2.0
#include "engine/reference/contact_oracle.h"

#include "engine/contact/near_pairs.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace fathom {

namespace {

dvec3 sphereCentre(const RegionSpheres& s, size_t i) {
    return {s.x[i], s.y[i], s.z[i]};
}

dvec3 leafCentre(const Tool& tool, size_t leaf, const Pose& baseTtool, const dvec3& origin) {
    return (baseTtool.position - origin) + baseTtool.rotation * tool.leaves()[leaf].centre;
}

} // namespace

std::vector<uint32_t> oracleSources(const Tool& tool, const Pose& baseTtool, double reach,
                                    const HostFixtures& fixtures) {
    std::vector<uint32_t> sources;
    for (const OraclePair& pair : oraclePairs(tool, baseTtool, reach + kPairMargin, fixtures)) {
        sources.push_back(pair.source);
    }
    std::sort(sources.begin(), sources.end());
    sources.erase(std::unique(sources.begin(), sources.end()), sources.end());
    return sources;
}

std::vector<OraclePair> oraclePairs(const Tool& tool, const Pose& baseTtool, double limit,
                                    const HostFixtures& fixtures) {
    std::vector<OraclePair> pairs;
    const RegionSpheres& s = fixtures.spheres;
    for (uint32_t t = 0; t < tool.leafCount(); ++t) {
        const dvec3 c = leafCentre(tool, t, baseTtool, fixtures.origin);
        for (size_t i = 0; i < s.size(); ++i) {
            const double gap = glm::distance(c, sphereCentre(s, i)) - tool.leaves()[t].radius - s.radius[i];
            if (gap <= limit) {
                pairs.push_back({t, s.source[i], gap});
            }
        }
    }
    std::sort(pairs.begin(), pairs.end());
    return pairs;
}

double oracleSmallestGap(const Tool& tool, const Pose& baseTtool, const HostFixtures& fixtures) {
    double smallest = std::numeric_limits<double>::infinity();
    const RegionSpheres& s = fixtures.spheres;
    for (size_t t = 0; t < tool.leafCount(); ++t) {
        const dvec3 c = leafCentre(tool, t, baseTtool, fixtures.origin);
        for (size_t i = 0; i < s.size(); ++i) {
            const double gap = glm::distance(c, sphereCentre(s, i)) - tool.leaves()[t].radius - s.radius[i];
            smallest = std::min(smallest, gap);
        }
    }
    return smallest;
}

SmallestGap oracleSmallestPair(const Tool& tool, const Pose& baseTtool, const HostFixtures& fixtures) {
    SmallestGap best;
    const RegionSpheres& s = fixtures.spheres;
    for (uint32_t t = 0; t < tool.leafCount(); ++t) {
        const dvec3 c = leafCentre(tool, t, baseTtool, fixtures.origin);
        for (size_t i = 0; i < s.size(); ++i) {
            const double dx = c.x - double{s.x[i]}, dy = c.y - double{s.y[i]}, dz = c.z - double{s.z[i]};
            const double gap =
                std::sqrt(dx * dx + dy * dy + dz * dz) - (tool.leaves()[t].radius + double{s.radius[i]});
            const std::array<double, 4> pair{gap, double(s.source[i]), double(s.fixture[i]), double(t)};
            const std::array<double, 4> least{best.gap, double(best.source), double(best.fixture),
                                              double(best.leaf)};
            if (pair < least) {
                best = {gap, s.source[i], t, s.fixture[i], glm::vec4(dvec3(sphereCentre(s, i)), s.radius[i])};
            }
        }
    }
    return best;
}

} // namespace fathom
