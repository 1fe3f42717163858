// SPDX-License-Identifier: Apache-2.0
#include "apps/profile/query_rows.h"

#include "apps/profile/brute_force.h"
#include "apps/profile/frame_sequence.h"

#include "engine/contact/cull_cpu.h"
#include "engine/cycle/contact_cycle.h"

#include <algorithm>
#include <numeric>
#include <set>

namespace fathom::profile {

namespace {

constexpr double kQueryReach = 0.01;   // [m]
constexpr double kMaxBrutePairs = 4e8; // limit of leaf-sphere pairs for brute force
constexpr float kSingleReach = static_cast<float>(kQueryReach);

// The spheres that a cull searches.
struct SphereSet {
    const RegionSpheres& spheres;
    const RegionGrid& grid;
    dvec3 origin; // [m] in the base frame
};

SphereSet setOf(const WallRig& rig) {
    return {rig.host().spheres, rig.bench.set().grid.get(), rig.host().origin};
}

// One tool in contact with a set, and the brute-force answer at that pose.
struct TouchingTool {
    Tool tool;
    Pose pose;
    PosedLeaves leaves;
    std::vector<uint8_t> marks;
    std::vector<uint32_t> truth;

    TouchingTool(const SphereSet& set, uint32_t leafCount, const Pose& touch)
        : tool(ballTool(leafCount))
        , pose(touch) {
        poseLeaves(tool, pose, set.origin, leaves);
        bruteForceCull(leaves, kSingleReach, set.spheres, marks, truth);
    }
    double pairs(const SphereSet& set) const {
        return static_cast<double>(tool.leafCount()) * static_cast<double>(set.spheres.size());
    }
    StudyRow row(const SphereSet& set, const char* method) const {
        StudyRow row = queryRow(sizeName(set.spheres),
                                std::string(method) + " " + std::to_string(tool.leafCount()) + " leaves");
        row.more[kToolLeaves] = static_cast<double>(tool.leafCount());
        row.more[kRegionSpheres] = static_cast<double>(set.spheres.size());
        row.more[kFoundSpheres] = static_cast<double>(truth.size());
        row.more[kReachMm] = kQueryReach * 1e3;
        return row;
    }
};

// One method of building a contact set: cull, sort, list all pairs, certify the reach.
struct QueryMethod {
    Plan plan;
    ContactCycle cycle;
    QueryMethod(gpu::Device& device, const WallRig& rig, Plan::Query query, const Tool& tool)
        : plan(planOf(rig, query))
        , cycle({&device, plan, rig.bench.cycle().layout(), rig.bench.cycle().sets()}, tool, kQueryReach) {}
    static Plan planOf(const WallRig& rig, Plan::Query query) {
        Plan plan = rig.bench.plan();
        plan.query = query;
        return plan;
    }
};

void verifyCull(std::vector<uint32_t>& found, const TouchingTool& at, const StudyRow& row) {
    std::sort(found.begin(), found.end());
    verify(found == at.truth, "query", row.setting, "the cull differs from brute force");
}

// The device lists a superset; the host decides later.
void verifyList(const NearPairs& near, const WallRig& rig, const TouchingTool& at, const StudyRow& row) {
    std::set<uint32_t> listed;
    for (const NearSphere& s : near.spheres) {
        listed.insert(s.source);
    }
    const bool all = std::all_of(at.truth.begin(), at.truth.end(),
                                 [&](uint32_t i) { return listed.count(rig.host().spheres.source[i]) > 0; });
    verify(all, "query", row.setting, "the device's list lacks a sphere that brute force finds");
}

// Times the list alone: device time, and submission to result. Separate runs, because timestamps take time;
// on a CPU device, more than a cull of few spheres.
void timeGpuCull(const StudyContext& context, const WallRig& rig, const TouchingTool& at, StudyRow& row) {
    NearPairs near;
    std::vector<double> gpu, submit;
    for (const bool stamped : {false, true}) {
        cloud::TreeQuery query(rig.bench.queryContext());
        query.setTool(at.tool);
        if (stamped) {
            query.enableTimestamps();
        }
        const auto cull = [&] { return query.list(rig.bench.set(), at.pose, kQueryReach, near); };
        verify(cull(), "query", row.setting, "overflow");
        verifyList(near, rig, at, row);
        repeat(context.settings.repeats(), cull, [&](const Clocks& c) {
            (stamped ? gpu : submit).push_back(stamped ? query.gpuMs() : c.wallMs());
        });
    }
    row.cost.gpu = context.device.facts().timestampPeriodNs > 0.0 ? spreadOf(gpu) : Spread{};
    row.more[kGpuCullSubmit] = spreadOf(submit).p50;
}

// Wall and CPU time of the cull alone.
void timeCpuCull(const StudyContext& context, const SphereSet& set, const TouchingTool& at, StudyRow& row) {
    CullCpu query;
    std::vector<uint32_t> found;
    const auto cull = [&] { query.cull(at.leaves, kSingleReach, set.grid, found); };
    cull();
    verifyCull(found, at, row);
    const Cost cost = timeCpu(context.settings.repeats(), cull);
    row.more[kCpuCullWall] = cost.submit.p50;
    row.more[kCpuCullCpu] = cost.cpu.p50;
}

StudyRow bruteRow(const StudyContext& context, const SphereSet& set, const TouchingTool& at) {
    StudyRow row = at.row(set, kBruteMethod);
    if (at.pairs(set) > kMaxBrutePairs) {
        return row;
    }
    std::vector<uint32_t> found;
    std::vector<uint8_t> marks;
    row.cost = timeCpu(context.settings.repeats(),
                       [&] { bruteForceCull(at.leaves, kSingleReach, set.spheres, marks, found); });
    return row;
}

// CPU, GPU and brute-force rows of one tool on one set.
std::vector<StudyRow> rowsOfTool(const StudyContext& context, const WallRig& rig, const TouchingTool& at) {
    QueryMethod cpu(context.device, rig, Plan::Query::Cpu, at.tool),
        gpu(context.device, rig, Plan::Query::Gpu, at.tool);
    ContactSet a, b;
    cpu.cycle.query(rig.bench.set(), at.pose, a);
    gpu.cycle.query(rig.bench.set(), at.pose, b);
    std::vector<StudyRow> rows{at.row(setOf(rig), kCpuMethod), at.row(setOf(rig), kGpuMethod)};
    verify(a.source == b.source && a.pairSphere == b.pairSphere && a.reach == b.reach, "query",
           rows[1].setting, "the contact sets of CPU and GPU differ");
    rows[0].cost = timeCpu(context.settings.repeats(), [&] { cpu.cycle.query(rig.bench.set(), at.pose, a); });
    timeCpuCull(context, setOf(rig), at, rows[0]);
    rows[1].cost = timeCpu(context.settings.repeats(), [&] { gpu.cycle.query(rig.bench.set(), at.pose, b); });
    timeGpuCull(context, rig, at, rows[1]);
    rows.push_back(bruteRow(context, setOf(rig), at));
    for (StudyRow& row : rows) {
        row.more[kFoundSpheres] = static_cast<double>(a.size());
        row.more[kReachMm] = a.reach * 1e3;
    }
    return rows;
}

// The `count` spheres nearest to a point [m, relative to their origin], in their original order.
RegionSpheres nearestOf(const RegionSpheres& all, const dvec3& to, size_t count) {
    std::vector<uint32_t> order(all.size());
    std::iota(order.begin(), order.end(), 0u);
    const auto away = [&](uint32_t i) { return glm::distance(dvec3(all.x[i], all.y[i], all.z[i]), to); };
    std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) { return away(a) < away(b); });
    order.resize(std::min(count, order.size()));
    std::sort(order.begin(), order.end());
    RegionSpheres few;
    for (const uint32_t i : order) {
        few.addFrom(all, i);
    }
    return few;
}

} // namespace

std::vector<std::string> queryColumnNames() {
    return {"gpu_cull_submit_to_result_p50_ms",
            "leaves",
            "spheres",
            "found_spheres",
            "stalled_turns",
            "reach_mm",
            "cpu_cull_wall_p50_ms",
            "cpu_cull_cpu_p50_ms"};
}

StudyRow queryRow(std::string source, std::string setting) {
    StudyRow row;
    row.source = std::move(source);
    row.setting = std::move(setting);
    row.more.assign(kQueryColumns, NAN);
    return row;
}

double cullTime(const StudyRow& row) {
    return isMethod(row, kCpuMethod)   ? row.more[kCpuCullWall]
           : isMethod(row, kGpuMethod) ? row.more[kGpuCullSubmit]
           : row.cost.submit           ? row.cost.submit.p50
                                       : NAN;
}

std::vector<StudyRow> queryRows(const StudyContext& context, uint32_t width, uint32_t height,
                                const std::vector<uint32_t>& toolLeaves) {
    const WallRig rig(context.device, width, height);
    const Pose touch = touchingPose(ballTool(256), rig.host(), Pose{});
    std::vector<StudyRow> rows;
    for (const uint32_t leaves : toolLeaves) {
        for (StudyRow& row : rowsOfTool(context, rig, TouchingTool(setOf(rig), leaves, touch))) {
            rows.push_back(std::move(row));
        }
    }
    return rows;
}

std::vector<StudyRow> fewSphereRows(const StudyContext& context) {
    const WallRig rig(context.device, 128, 80);
    const Pose touch = touchingPose(ballTool(256), rig.host(), Pose{});
    std::vector<StudyRow> rows;
    for (const size_t count : {16, 64, 256}) {
        const RegionSpheres spheres =
            nearestOf(rig.host().spheres, touch.position - rig.host().origin, count);
        RegionGrid grid;
        grid.build(spheres);
        const SphereSet set{spheres, grid, rig.host().origin};
        for (const uint32_t leaves : {1u, 4u, 16u}) {
            const TouchingTool at(set, leaves, touch);
            timeCpuCull(context, set, at, rows.emplace_back(at.row(set, kCpuMethod)));
            rows.push_back(bruteRow(context, set, at));
        }
    }
    return rows;
}

} // namespace fathom::profile
