// SPDX-License-Identifier: Apache-2.0
// Fixture sets and tools for the contact and proxy tests: random clouds, walls of spheres, tools of many
// leaves.
#pragma once

#include "engine/contact/host_fixtures.h"
#include "engine/contact/tool.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace fathom::testing {

inline const dquat kUpright(1.0, 0.0, 0.0, 0.0);

inline dvec3 randomIn(std::mt19937_64& random, double half) {
    std::uniform_real_distribution<double> u(-half, half);
    const double x = u(random), y = u(random);
    return {x, y, u(random)};
}

inline dquat randomRotation(std::mt19937_64& random) {
    std::normal_distribution<double> n;
    const double w = n(random), x = n(random), y = n(random);
    return glm::normalize(dquat(w, x, y, n(random)));
}

// Sources in an order unrelated to position, as from patches.
inline void shuffleSources(HostFixtures& fixtures, std::mt19937_64& random) {
    std::shuffle(fixtures.spheres.source.begin(), fixtures.spheres.source.end(), random);
}

inline HostFixtures emptySet(uint64_t generation = 1) {
    HostFixtures fixtures;
    fixtures.frame = static_cast<int64_t>(generation);
    fixtures.generation = generation;
    return fixtures;
}

inline HostFixtures randomCloud(std::mt19937_64& random, size_t count, double half, double smallest,
                                double largest) {
    HostFixtures fixtures = emptySet();
    std::uniform_real_distribution<double> logRadius(std::log(smallest), std::log(largest));
    for (size_t i = 0; i < count; ++i) {
        const dvec3 centre = randomIn(random, half);
        fixtures.spheres.add(centre, std::exp(logRadius(random)));
    }
    shuffleSources(fixtures, random);
    return fixtures;
}

// Square patch of a plane through `centre` spanned by the unit vectors u and v: spheres every `spacing`.
inline void addWall(HostFixtures& fixtures, const dvec3& centre, const dvec3& u, const dvec3& v, double half,
                    double spacing, double radius) {
    const int n = static_cast<int>(std::lround(half / spacing));
    for (int i = -n; i <= n; ++i) {
        for (int j = -n; j <= n; ++j) {
            fixtures.spheres.add(centre + (spacing * i) * u + (spacing * j) * v, radius);
        }
    }
}

inline Tool makeTool(const std::vector<Sphere>& leaves) {
    return Tool(buildSphereTree(leaves));
}

inline Tool ballTool(double radius) {
    return makeTool({{dvec3(0.0), radius}});
}

inline Tool randomTool(std::mt19937_64& random, size_t leaves, double half, double radius) {
    std::vector<Sphere> spheres;
    for (size_t i = 0; i < leaves; ++i) {
        spheres.push_back({randomIn(random, half), radius});
    }
    return makeTool(spheres);
}

} // namespace fathom::testing
