// SPDX-License-Identifier: Apache-2.0
// The start-up test of the contact query: pairs whose gap is the reach or the limit of a band, up to the
// rounding of a float.
#include "engine/cloud/tree_query.h"

#include "engine/contact/exact_gap.h"
#include "engine/types/pose.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <random>

namespace fathom::cloud {

namespace {

constexpr size_t kProbes = 1000; // spheres: more than one block
constexpr double kProbeReach = 0.01;

Tool probeTool(std::mt19937_64& random) {
    std::uniform_real_distribution<double> at(-0.1, 0.1), radius(0.001, 0.02);
    std::vector<Sphere> leaves;
    for (int i = 0; i < 70; ++i) { // more than two slices of a small tool
        leaves.push_back({{at(random), at(random), at(random)}, radius(random)});
    }
    return Tool(buildSphereTree(leaves));
}

struct Probe {
    std::vector<glm::vec4> spheres;
    std::map<std::pair<uint32_t, uint32_t>, uint32_t> within; // sphere and leaf -> bucket
    double largest = 0.0;                                     // [m] radius

    // Whether the answer about a pair is right; then it is no longer missing.
    bool take(uint32_t sphere, uint32_t bucket) {
        const bool decided = bucket < NearPairs::kUndecided;
        const auto pair = within.find({sphere, (bucket & ~NearPairs::kUndecided) / ContactSet::kGapBands});
        if (pair == within.end()) {
            return !decided;
        }
        const bool right = !decided || pair->second == bucket;
        within.erase(pair);
        return right;
    }
};

// Every second sphere at the reach, the others at the limits of bands.
double limitOf(uint32_t sphere) {
    const uint32_t bands = sphere % 2 == 0 ? ContactSet::kGapBands : sphere / 2 % ContactSet::kGapBands;
    return kProbeReach * bands / ContactSet::kGapBands;
}

// Moves a sphere along its direction to the farthest float position where its gap to the leaf is at most
// `limit`.
glm::vec4 atLimit(double limit, const dvec3& leaf, double leafRadius, const dvec3& direction, float radius) {
    const double wanted = limit + leafRadius + double{radius};
    const auto gap = [&](const glm::vec3& s) { return glm::distance(leaf, dvec3(s)) - wanted; };
    double length = wanted * (1.0 + 1e-6);
    while (gap(glm::vec3(leaf + direction * length)) > 0.0) {
        length *= 1.0 - 1e-7;
    }
    return glm::vec4(glm::vec3(leaf + direction * length), radius);
}

Probe probeAt(const Tool& tool, const Pose& pose, std::mt19937_64& random) {
    std::normal_distribution<double> n;
    std::uniform_real_distribution<double> logRadius(std::log(1e-3), std::log(0.1));
    Probe probe;
    ContactSet bands; // for its bands alone
    bands.reach = kProbeReach;
    std::vector<dvec3> leaves;
    for (const Sphere& leaf : tool.leaves()) {
        leaves.push_back(pose.apply(leaf.centre));
    }
    for (uint32_t i = 0; i < kProbes; ++i) {
        const size_t leaf = i % leaves.size();
        const dvec3 direction = glm::normalize(dvec3(n(random), n(random), n(random)));
        probe.spheres.push_back(atLimit(limitOf(i), leaves[leaf], tool.leaves()[leaf].radius, direction,
                                        static_cast<float>(std::exp(logRadius(random)))));
        const glm::vec4& s = probe.spheres.back();
        probe.largest = std::max(probe.largest, double{s.w});
        for (uint32_t l = 0; l < leaves.size(); ++l) {
            const double gap = exactGap({leaves[l], tool.leaves()[l].radius}, s.x, s.y, s.z, s.w);
            if (gap <= kProbeReach) {
                probe.within.emplace(std::pair(i, l), l * ContactSet::kGapBands + bands.bandOf(gap));
            }
        }
    }
    return probe;
}

} // namespace

bool TreeQuery::passesProbe(double shorter, float margins) {
    std::mt19937_64 random(1);
    const Tool tool = probeTool(random);
    setTool(tool);
    size_t wrong = 0;
    for (const double away : {0.0, 0.7, 20.0}) { // [m] from the origin of the spheres
        const Pose pose{dvec3(away, -away, 0.3 * away), rotationExp(dvec3(1.1, -0.4, 2.3))};
        Probe probe = probeAt(tool, pose, random);
        frozen_.fill(probe.spheres);
        makeBindings();
        shared::QueryParams params = paramsAt(pose, dvec3(0.0), kProbeReach, probe.largest);
        params.reach -= static_cast<float>(shorter);
        params.margin *= margins;
        const Blocks blocks = frozenBlocks();
        while (!run({&blocks, 1}, {}, params).fits(answer_.capacity()) && answer_.growTo(answer_.found())) {
            makeBindings();
        }
        for (const shared::FoundSphere& f : answer_.spheres()) {
            const bool same = probe.spheres[f.slot >> 2] == f.sphere; // the host decides by these values
            for (uint32_t k = 0; same && k < f.count; ++k) {
                wrong += probe.take(f.slot >> 2, answer_.buckets()[f.first + k]) ? 0 : 1;
            }
        }
        wrong += probe.within.size();
    }
    frozen_.fill({});
    leaves_.drop();
    bindings_.clear();
    return wrong == 0;
}

} // namespace fathom::cloud
