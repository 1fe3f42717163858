// SPDX-License-Identifier: Apache-2.0
#include "apps/profile/query_limit.h"

#include "apps/profile/frame_sequence.h"
#include "engine/cloud/tree_query.h"
#include "engine/contact/cull_cpu.h"
#include "shaders/shared/query_params.h"

#include <algorithm>
#include <set>

namespace fathom::profile {

namespace {

constexpr double kLimitReach = 0.01;     // [m]
constexpr double kTestOperations = 12.0; // per test: d^2 takes 8, the squared limit 3, the comparison 1
constexpr double kSphereBytes = 16.0;    // of one sphere, bound or leaf

// The patch of each sphere.
std::vector<uint32_t> patchesOf(const HostFixtures& host, const std::vector<uint32_t>& source,
                                const PatchLayout& layout) {
    const uint32_t width = host.camera.depth.width, pixels = host.camera.depth.pixels();
    std::vector<uint32_t> patches;
    for (const uint32_t s : source) {
        patches.push_back(s % pixels / width / 16 * layout.across + s % pixels % width / 16);
    }
    return patches;
}

} // namespace

// Bytes count once each, as with a perfect cache: parameters, the bound of every patch, the leaves, the slots
// of the answer's patches, and the answer. Operations: one test per patch, one per leaf and patch of the
// answer, one per pair of the answer, and one per other sphere of these patches.
QueryWork leastQueryWork(const PatchLayout& layout, uint32_t layers, size_t leaves,
                         std::span<const uint32_t> patches, std::span<const uint32_t> found, size_t pairs) {
    const std::set<uint32_t> reached(found.begin(), found.end());
    const auto looked = static_cast<double>(std::count_if(
        patches.begin(), patches.end(), [&](uint32_t patch) { return reached.count(patch) > 0; }));
    const auto blocks = static_cast<double>(reached.size()), tool = static_cast<double>(leaves),
               spheres = static_cast<double>(found.size()), listed = static_cast<double>(pairs);
    QueryWork work;
    work.bytes = sizeof(shared::QueryParams) + kSphereBytes * layout.patches() +
                 kSphereBytes * ((reached.empty() ? 0.0 : tool) + blocks * shared::kBlockSlots * layers) +
                 sizeof(shared::FoundSphere) * spheres + sizeof(uint32_t) * listed;
    work.operations = kTestOperations * (layout.patches() + blocks * tool + listed + (looked - spheres));
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
    const PatchLayout& layout = bench.cycle().layout();
    cloud::TreeQuery query(bench.queryContext());
    query.setTool(tool);
    query.enableTimestamps();
    NearPairs near;
    DecideScratch scratch;
    ContactSet device, host;
    fillContactSet(tool, pose, kLimitReach, set.host, {}, device);
    verify(query.list(set, pose, kLimitReach, near) && decidePairs(tool, near, SIZE_MAX, scratch, device),
           "limit", "tree_query", "overflow");
    CullCpu({SIZE_MAX, SIZE_MAX}).query(tool, pose, kLimitReach, set.host, set.grid.get(), host);
    verify(device.source == host.source && device.pairSphere == host.pairSphere && device.size() > 0, "limit",
           "tree_query", "the contact sets of CPU and GPU differ");
    limit.leaves = tool.leafCount();
    limit.found = device.size();
    limit.least = leastQueryWork(layout, bench.plan().hold ? 2 : 1, tool.leafCount(),
                                 patchesOf(set.host, set.host.spheres.source, layout),
                                 patchesOf(set.host, device.source, layout), device.pairSphere.size());
    std::vector<double> ms;
    repeat(
        context.settings.repeats(), [&] { query.list(set, pose, kLimitReach, near); },
        [&](const Clocks&) { ms.push_back(query.gpuMs()); });
    limit.time = context.device.facts().timestampPeriodNs > 0.0 ? spreadOf(ms) : Spread{};
    return limit;
}

} // namespace fathom::profile
