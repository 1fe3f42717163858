// SPDX-License-Identifier: Apache-2.0
#include "apps/profile/query_limit.h"

#include "apps/profile/brute_force.h"
#include "apps/profile/frame_sequence.h"
#include "engine/cloud/tree_query.h"
#include "shaders/shared/query_params.h"

#include <algorithm>
#include <set>

namespace fathom::profile {

namespace {

constexpr float kLimitReach = 0.01f;     // [m]
constexpr double kTestOperations = 12.0; // per test: d^2 takes 8, the squared limit 3, the comparison 1
constexpr double kNodeBytes = 16.0;      // bytes of a node or a sphere, region or tool
constexpr double kSlotsOfSub = 16.0;     // slots of a sub-patch in each layer
constexpr uint32_t kKeysOfPatch = 512;   // FixtureSet::keys: two layers of 256 slots

uint32_t subPatchOf(uint32_t key) {
    return key / kKeysOfPatch * 16 + key % 256 / 16;
}

// Adds the nodes above a sub-patch up to the root, as the shader's ancestorsInReach() computes them.
void addAncestors(const PatchLayout& layout, uint32_t sub, std::set<uint32_t>& nodes) {
    const uint32_t patch = sub / 16, u = patch % layout.across, v = patch / layout.across;
    for (size_t level = 1; level < layout.levels.size(); ++level) {
        const auto shift = static_cast<uint32_t>(2 * (level - 1));
        nodes.insert(layout.levels[level].first + (v >> shift) * layout.levels[level].across + (u >> shift));
    }
}

} // namespace

// Bytes count once each, as with a perfect cache: parameters, count, the region's root, the answer, and for
// the answer's sub-patches their nodes, ancestors and slots, and one path down the tool's tree. Operations:
// every invocation (one per sub-patch) tests the root. Those of the answer's sub-patches test every node down
// to their own. That node and each found sphere descend the tool's tree to a leaf; every other sphere there
// is tested once.
QueryWork leastQueryWork(const PatchLayout& layout, uint32_t layers, uint32_t toolLevels,
                         std::span<const uint32_t> keys, std::span<const uint32_t> found) {
    std::set<uint32_t> subs, ancestors;
    for (const uint32_t index : found) {
        subs.insert(subPatchOf(keys[index]));
    }
    ancestors.insert(layout.levels.back().first);
    for (const uint32_t sub : subs) {
        addAncestors(layout, sub, ancestors);
    }
    const auto looked = static_cast<double>(std::count_if(
        keys.begin(), keys.end(), [&](uint32_t key) { return subs.count(subPatchOf(key)) > 0; }));
    const auto count = static_cast<double>(found.size()), reached = static_cast<double>(subs.size()),
               down = static_cast<double>(toolLevels), levels = static_cast<double>(layout.levels.size());
    QueryWork work;
    work.bytes = sizeof(shared::QueryParams) + sizeof(uint32_t) * (1.0 + count) +
                 kNodeBytes * (static_cast<double>(ancestors.size()) +
                               reached * (1.0 + kSlotsOfSub * layers) + (found.empty() ? 1.0 : down));
    work.operations = kTestOperations * (16.0 * layout.patches() + reached * (levels - 1.0 + down - 1.0) +
                                         count * down + (looked - count));
    return work;
}

QueryLimit measureQuery(const StudyContext& context, const FrameBench& bench, const Pose& baseTcamera) {
    QueryLimit limit;
    const cloud::FixtureSet& set = bench.set();
    limit.spheres = set.host.spheres.size();
    if (limit.spheres == 0) {
        return limit;
    }
    const Tool tool = ballTool(256);
    const Pose pose = touchingPose(tool, set.host, baseTcamera);
    PosedLeaves leaves;
    poseLeaves(tool, pose, set.host.origin, leaves);
    cloud::TreeQuery query(context.device, bench.plan(), bench.cycle().layout(), bench.cycle().sets(), tool,
                           static_cast<uint32_t>(limit.spheres));
    query.askForTime();
    std::vector<uint32_t> found, truth;
    std::vector<uint8_t> marks;
    verify(query.cull(set, leaves, pose, kLimitReach, found), "limit", "tree_query", "overflow");
    std::sort(found.begin(), found.end());
    bruteForceCull(leaves, kLimitReach, set.host.spheres, marks, truth);
    verify(found == truth && !found.empty(), "limit", "tree_query", "the cull differs from brute force");
    limit.leaves = tool.leafCount(), limit.found = found.size();
    limit.least = leastQueryWork(bench.cycle().layout(), bench.plan().hold ? 2 : 1, tool.tree().levels,
                                 set.keys, found);
    std::vector<double> ms;
    repeat(
        context.settings.repeats(), [&] { query.cull(set, leaves, pose, kLimitReach, found); },
        [&](const Clocks&) { ms.push_back(query.gpuMs()); });
    limit.time = context.device.facts().timestampPeriodNs > 0.0 ? spreadOf(ms) : Spread{};
    return limit;
}

} // namespace fathom::profile
