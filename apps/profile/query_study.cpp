// SPDX-License-Identifier: Apache-2.0
// Query time over tool leaves and region spheres: CPU, GPU, brute force; where they cross, which `where:
// auto` then uses; and what the reach costs when answers come late.
#include "apps/profile/brute_force.h"
#include "apps/profile/late_answers.h"
#include "apps/profile/shot_source.h"
#include "apps/profile/studies.h"

#include "engine/contact/cull_cpu.h"
#include "engine/cycle/contact_cycle.h"
#include "engine/gpu/query_crossover.h"

#include <algorithm>
#include <map>

namespace fathom::profile {

namespace {

constexpr double kQueryReach = 0.01;    // [m]
constexpr double kMostBrutePairs = 4e8; // leaf-sphere pairs that brute force is let try

struct Size {
    uint32_t width, height;
};

// The wall as a set of width x height spheres, and where the tool touches it.
struct QueryRig {
    ShotSource source;
    FrameBench bench;

    QueryRig(gpu::Device& device, const Size& size)
        : source(wallShot(size.width, size.height, 1.0))
        , bench(device, everyPointScene(), source.camera) {
        bench.run(source.shots.front());
    }
    const Fixtures& host() const { return bench.set().host; }
    std::string name() const {
        return digits(static_cast<double>(host().spheres.size()) / 1000.0, 4) + " k spheres";
    }
};

// The contact set by whichever way: culled, sorted, all pairs listed, certified.
struct Way {
    Plan plan;
    ContactCycle cycle;
    Way(gpu::Device& device, const QueryRig& rig, Plan::Query query, const Tool& tool)
        : plan(planOf(rig, query))
        , cycle(device, plan, rig.bench.cycle().layout(), rig.bench.cycle().sets(), tool, kQueryReach) {}
    static Plan planOf(const QueryRig& rig, Plan::Query query) {
        Plan plan = rig.bench.plan();
        plan.query = query;
        return plan;
    }
};

std::string settingOf(const char* way, uint32_t leaves) {
    return std::string(way) + " " + std::to_string(leaves) + " leaves";
}

// Device time and submit-to-result of the cull alone.
void timeGpuCull(const StudyContext& context, const QueryRig& rig, const Tool& tool, const Pose& pose,
                 StudyRow& row) {
    cloud::TreeQuery query(context.device, rig.bench.plan(), rig.bench.cycle().layout(),
                           rig.bench.cycle().sets(), tool, 1u << 21);
    query.askForTime();
    PosedLeaves leaves;
    poseLeaves(tool, pose, rig.host().origin, leaves);
    std::vector<uint32_t> found, brute;
    std::vector<uint8_t> marks;
    verify(query.cull(rig.bench.set(), leaves, pose, static_cast<float>(kQueryReach), found), "query",
           row.setting, "overflow");
    std::sort(found.begin(), found.end());
    bruteForceCull(leaves, static_cast<float>(kQueryReach), rig.host().spheres, marks, brute);
    verify(found == brute, "query", row.setting, "the GPU cull differs from brute force");
    std::vector<double> gpu, submit;
    repeat(
        context.settings.effort(),
        [&] { query.cull(rig.bench.set(), leaves, pose, static_cast<float>(kQueryReach), found); },
        [&](const Clocks& c) {
            submit.push_back(c.wallMs());
            gpu.push_back(query.gpuMs());
        });
    row.cost.gpu = context.device.facts().timestampPeriodNs > 0.0 ? spreadOf(gpu) : Spread{};
    row.more = {spreadOf(submit).p50};
}

StudyRow bruteRow(const StudyContext& context, const QueryRig& rig, const Tool& tool, const Pose& pose) {
    StudyRow row;
    row.source = rig.name();
    row.setting = settingOf("brute force", static_cast<uint32_t>(tool.leafCount()));
    PosedLeaves leaves;
    poseLeaves(tool, pose, rig.host().origin, leaves);
    std::vector<uint32_t> found;
    std::vector<uint8_t> marks;
    const double pairs =
        static_cast<double>(tool.leafCount()) * static_cast<double>(rig.host().spheres.size());
    if (pairs > kMostBrutePairs) {
        return row;
    }
    row.cost = timeCpu(context.settings.effort(), [&] {
        bruteForceCull(leaves, static_cast<float>(kQueryReach), rig.host().spheres, marks, found);
    });
    row.more = {NAN};
    return row;
}

// CPU, GPU and brute force rows of one tool on one set.
std::vector<StudyRow> rowsOf(const StudyContext& context, const QueryRig& rig, uint32_t leafCount,
                             const Pose& pose) {
    const Tool tool = ballTool(leafCount);
    Way cpu(context.device, rig, Plan::Query::Cpu, tool), gpu(context.device, rig, Plan::Query::Gpu, tool);
    ContactSet a, b;
    cpu.cycle.query(rig.bench.set(), pose, a);
    gpu.cycle.query(rig.bench.set(), pose, b);
    const std::string setting = settingOf("GPU", leafCount);
    verify(a.source == b.source && a.pairSphere == b.pairSphere && a.reach == b.reach, "query", setting,
           "the contact sets of CPU and GPU differ");
    std::vector<StudyRow> rows(2);
    rows[0].setting = settingOf("CPU", leafCount);
    rows[0].cost = timeCpu(context.settings.effort(), [&] { cpu.cycle.query(rig.bench.set(), pose, a); });
    rows[0].more = {NAN};
    rows[1].setting = setting;
    rows[1].cost = timeCpu(context.settings.effort(), [&] { gpu.cycle.query(rig.bench.set(), pose, b); });
    timeGpuCull(context, rig, tool, pose, rows[1]);
    rows.push_back(bruteRow(context, rig, tool, pose));
    for (StudyRow& row : rows) {
        row.source = rig.name();
        row.more.resize(1, NAN);
        row.more.insert(row.more.end(),
                        {static_cast<double>(leafCount), static_cast<double>(rig.host().spheres.size()),
                         static_cast<double>(a.size()), NAN, a.reach * 1e3});
    }
    return rows;
}

// The fewest leaves from which on the GPU is faster at every larger tool of that set.
uint32_t crossingOf(const std::vector<StudyRow>& rows, const std::string& source) {
    std::map<double, std::pair<double, double>> byLeaves; // CPU, GPU
    for (const StudyRow& row : rows) {
        if (row.source == source && row.setting.rfind("brute", 0) != 0) {
            auto& pair = byLeaves[row.more[1]];
            (row.setting.rfind("CPU", 0) == 0 ? pair.first : pair.second) = row.cost.submit.p50;
        }
    }
    uint32_t crossing = gpu::kNeverOnGpu;
    for (auto it = byLeaves.rbegin(); it != byLeaves.rend() && it->second.second < it->second.first; ++it) {
        crossing = static_cast<uint32_t>(it->first);
    }
    return crossing;
}

void drawTimes(Study& study, const std::vector<std::string>& sources) {
    PlotPanel panel;
    panel.title = "contact set: CPU solid, GPU dashed, brute force dotted";
    panel.xLabel = "tool leaves";
    panel.yLabel = "query p50 [ms]";
    constexpr std::pair<const char*, double> kWays[] = {{"CPU", 0.0}, {"GPU", 9.0}, {"brute", 3.0}};
    int colour = 0;
    for (const std::string& source : sources) {
        for (const auto& [way, dash] : kWays) {
            PlotSeries series{std::string(way) + ", " + source, {}, true, colour, dash};
            for (const StudyRow& row : study.rows) {
                if (row.source == source && row.setting.rfind(way, 0) == 0 && row.cost.submit) {
                    series.points.push_back({row.more[1], row.cost.submit.p50, "", false, false});
                }
            }
            panel.series.push_back(std::move(series));
        }
        ++colour;
    }
    study.panels.push_back(std::move(panel));
}

void concludeCrossover(const StudyContext& context, Study& study, const std::vector<std::string>& sources) {
    uint32_t crossover = 0;
    for (const std::string& source : sources) {
        const uint32_t crossing = crossingOf(study.rows, source);
        study.findings.push_back(source + ": " +
                                 (crossing == gpu::kNeverOnGpu
                                      ? "the CPU is faster at every tool measured"
                                      : "the GPU is faster from " + std::to_string(crossing) + " leaves on"));
        crossover = std::max(crossover, crossing);
    }
    if (context.settings.quick) {
        study.findings.push_back("a quick run stores no crossover; 'where: auto' uses " +
                                 std::to_string(context.device.facts().gpuQueryLeaves) + " leaves");
        return;
    }
    const bool stored = gpu::storeQueryCrossover(context.device.physical(), crossover);
    study.findings.push_back(
        std::string("'where: auto' asks the GPU ") +
        (crossover == gpu::kNeverOnGpu ? "never" : "from " + std::to_string(crossover) + " leaves on") +
        " on this device" + (stored ? ": stored for later runs" : ", but it could not be stored"));
}

} // namespace

Study queryStudy(const StudyContext& context) {
    Study study;
    study.name = "query";
    study.title = "Query: time over tool leaves and region spheres, and what the reach costs";
    study.verified = "contact sets of CPU and GPU equal bit by bit, culls equal to brute force; no leaf in a "
                     "sphere in any run";
    study.errorName = "lag of the tool behind the hand RMS";
    study.errorUnit = "mm";
    study.timeName = "query p50";
    study.moreNames = {"gpu_cull_submit_to_result_p50_ms",
                       "leaves",
                       "spheres",
                       "found_spheres",
                       "stalled_turns",
                       "reach_mm"};
    const bool quick = context.settings.quick;
    const std::vector<Size> sizes =
        quick ? std::vector<Size>{{40, 30}, {128, 96}}
              : std::vector<Size>{{40, 25}, {128, 80}, {300, 200}, {640, 480}, {1280, 800}};
    std::vector<std::string> sources;
    for (const Size& size : sizes) {
        const QueryRig rig(context.device, size);
        const Pose pose = touchingPose(ballTool(256), rig.host(), Pose{});
        sources.push_back(rig.name());
        for (uint32_t leaves : quick ? std::vector<uint32_t>{1, 64, 1000}
                                     : std::vector<uint32_t>{1, 4, 16, 64, 256, 1024, 4096}) {
            for (StudyRow& row : rowsOf(context, rig, leaves, pose)) {
                study.rows.push_back(std::move(row));
            }
        }
    }
    concludeCrossover(context, study, sources);
    drawTimes(study, sources);
    addLateAnswers(context, study);
    return study;
}

} // namespace fathom::profile
