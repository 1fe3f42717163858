// SPDX-License-Identifier: Apache-2.0
// Batches: the smallest gap of a tool at many poses, on the GPU and on the CPU, over poses, leaves and
// spheres.
#include "apps/profile/frame_bench.h"
#include "apps/profile/frame_sequence.h"
#include "apps/profile/studies.h"
#include "engine/cloud/gap_query.h"
#include "engine/reference/contact_oracle.h"

#include <algorithm>
#include <random>

namespace fathom::profile {

namespace {

constexpr size_t kBatchPoses = 0, kBatchLeaves = 1, kListedPairs = 3; // of StudyRow::more
constexpr double kMaxPairs = 1e8;     // that the oracle compares per tool and set
constexpr size_t kFirstVerified = 16; // poses, then some more, evenly spread
constexpr size_t kMoreVerified = 48;
constexpr Repeats kOnCpu{3, 20, 0.2};
constexpr double kMaxCpuSeconds = 1.0; // of a batch on the CPU, all its repetitions together
constexpr double kBatchGoalMs = 1.0;   // 4096 poses of 256 leaves at 60 k spheres
const char* const kGpuBatch = "GPU";
const char* const kCpuBatch = "CPU";

// Poses from 5 mm inside of contact to 0.3 m before the wall, up to 0.2 m sideways, turned at random.
std::vector<Pose> batchPoses(const WallRig& rig, const Tool& tool, size_t count) {
    const Pose touch = touchingPose(tool, rig.host(), Pose{});
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> side(-0.2, 0.2), back(-0.005, 0.3), turn(-2.0, 2.0);
    std::vector<Pose> poses;
    for (size_t i = 0; i < count; ++i) {
        const dvec3 move(side(random), side(random), -back(random));
        poses.push_back({touch.position + move, rotationExp({turn(random), turn(random), turn(random)})});
    }
    return poses;
}

StudyRow batchRow(const WallRig& rig, const char* way, const Tool& tool, size_t poses) {
    StudyRow row;
    row.source = sizeName(rig.host().spheres);
    row.setting = std::string(way) + " " + std::to_string(poses) + " poses, " +
                  std::to_string(tool.leafCount()) + " leaves";
    row.more = {static_cast<double>(poses), static_cast<double>(tool.leafCount()),
                static_cast<double>(rig.host().spheres.size()), NAN};
    return row;
}

// What batches of one tool must answer at some of its poses.
struct Expected {
    std::vector<std::pair<size_t, SmallestGap>> gaps; // by index of the pose
    double cpuSeconds = 0.0;                          // per pose, on the host
};

// By the search on the host, and for a few poses also by brute force over all pairs.
Expected expectedOf(const WallRig& rig, const Tool& tool, const std::vector<Pose>& poses) {
    const HostFixtures& set = rig.host();
    GapSearch search;
    search.build(set);
    Expected expected;
    const size_t step = std::max<size_t>(1, poses.size() / kMoreVerified);
    const Clocks clocks;
    for (size_t i = 0; i < poses.size(); ++i) {
        if (i < kFirstVerified || i % step == 0) {
            expected.gaps.emplace_back(i, search.find(tool, poses[i]));
        }
    }
    expected.cpuSeconds = clocks.wallMs() / 1e3 / static_cast<double>(expected.gaps.size());
    const double pairs = static_cast<double>(tool.leafCount()) * static_cast<double>(set.spheres.size());
    const auto brute = static_cast<size_t>(std::min(4.0, kMaxPairs / pairs));
    for (size_t i = 0; i < std::min(brute, poses.size()); ++i) {
        verify(expected.gaps[i].second == oracleSmallestPair(tool, poses[i], set), "batch",
               sizeName(rig.host().spheres),
               "the search on the host differs from brute force at pose " + std::to_string(i));
    }
    return expected;
}

void verifyBatch(const Expected& expected, const std::vector<SmallestGap>& gaps, const StudyRow& row) {
    for (const auto& [i, gap] : expected.gaps) {
        verify(i >= gaps.size() || gaps[i] == gap, "batch", row.setting,
               "pose " + std::to_string(i) + " has another smallest gap");
    }
}

Repeats repeatsOnGpu(const StudyContext& context) {
    return context.settings.quick ? context.settings.repeats() : Repeats{20, 200, 0.3};
}

// Device time and time to result in separate runs, because timestamps take time.
StudyRow gpuBatchRow(const StudyContext& context, const WallRig& rig, const Tool& tool,
                     const std::vector<Pose>& poses, const Expected& expected) {
    StudyRow row = batchRow(rig, kGpuBatch, tool, poses.size());
    std::vector<double> gpu, submit;
    std::vector<SmallestGap> gaps, first;
    for (const bool stamped : {false, true}) {
        cloud::GapQuery query(rig.bench.queryContext());
        query.setTool(tool);
        if (stamped) {
            query.enableTimestamps();
        }
        const auto ask = [&] { query.find(rig.bench.set(), tool, poses, gaps); };
        ask();
        verifyBatch(expected, gaps, row);
        verify(!stamped || gaps == first, "batch", row.setting, "two runs give other smallest gaps");
        first = gaps;
        row.more[kListedPairs] = query.pairs();
        repeat(repeatsOnGpu(context), ask, [&](const Clocks& c) {
            (stamped ? gpu : submit).push_back(stamped ? query.gpuMs() : c.wallMs());
        });
    }
    row.cost.gpu = context.device.facts().timestampPeriodNs > 0.0 ? spreadOf(gpu) : Spread{};
    row.cost.submit = spreadOf(submit);
    return row;
}

StudyRow cpuBatchRow(const WallRig& rig, const Tool& tool, const std::vector<Pose>& poses) {
    StudyRow row = batchRow(rig, kCpuBatch, tool, poses.size());
    GapSearch search;
    search.build(rig.host());
    double sum = 0.0; // so that no search is optimised away
    row.cost = timeCpu(kOnCpu, [&] {
        for (const Pose& pose : poses) {
            sum += search.find(tool, pose).gap;
        }
    });
    verify(std::isfinite(sum), "batch", row.setting, "a pose has no gap");
    return row;
}

void addRows(const StudyContext& context, Study& study, const WallRig& rig,
             const std::vector<uint32_t>& tools, const std::vector<size_t>& batches) {
    for (const uint32_t leaves : tools) {
        const Tool tool = ballTool(leaves);
        const std::vector<Pose> poses = batchPoses(rig, tool, batches.back());
        const Expected expected = expectedOf(rig, tool, poses);
        for (const size_t count : batches) {
            const std::vector<Pose> some(poses.begin(), poses.begin() + static_cast<long>(count));
            study.rows.push_back(gpuBatchRow(context, rig, tool, some, expected));
            const double runs = static_cast<double>(kOnCpu.least + 1), one = expected.cpuSeconds;
            if (runs * one * static_cast<double>(count) <= kMaxCpuSeconds) {
                study.rows.push_back(cpuBatchRow(rig, tool, some));
            }
        }
    }
}

PlotPanel batchPanel(const Study& study) {
    PlotPanel panel;
    panel.title = "time of a batch: GPU solid, CPU dashed";
    panel.xLabel = "poses";
    panel.yLabel = "submission to result p50 [ms]";
    std::vector<std::string> names;
    for (const StudyRow& row : study.rows) {
        const bool gpu = row.setting.starts_with(kGpuBatch);
        const std::string leaves = digits(row.more[kBatchLeaves], 5) + " leaves, " + row.source;
        const std::string name = std::string(gpu ? kGpuBatch : kCpuBatch) + ", " + leaves;
        auto found = std::find(names.begin(), names.end(), name);
        if (found == names.end()) {
            panel.series.push_back({name, {}, true, gpu ? 0.0 : 9.0, leaves});
            found = names.insert(names.end(), name);
        }
        panel.series[static_cast<size_t>(found - names.begin())].points.push_back(
            {row.more[kBatchPoses], submitTime(row), "", false, false, NAN, p90Of(row, submitTime(row))});
    }
    return panel;
}

void concludeBatch(Study& study) {
    study.findings.push_back("CPU: medians of " + std::to_string(kOnCpu.least) + " to " +
                             std::to_string(kOnCpu.most) + " runs; batches that would take over " +
                             digits(kMaxCpuSeconds) + " s are not timed");
    for (const StudyRow& row : study.rows) {
        if (row.setting == "GPU 4096 poses, 256 leaves") {
            const double ms = submitTime(row);
            study.findings.push_back(
                row.source + ", 4096 poses of 256 leaves: " + digits(ms) + " ms from submission to result, " +
                digits(gpuTime(row)) +
                " ms of it by the device's clock (goal at 60 k: " + digits(kBatchGoalMs) + " ms)");
        }
    }
}

} // namespace

Study batchStudy(const StudyContext& context) {
    Study study;
    study.name = "batch";
    study.title = "Batch: the smallest gap of a tool at many poses in one submission";
    study.verified =
        "gap and pair of up to 64 poses per batch equal to the search on the host, of up to 4 poses "
        "(at most 1e8 pairs) also to brute force over all pairs, to the last bit; two runs of "
        "each batch equal at every pose";
    study.errorName = "none: the answers are exact";
    study.errorUnit = "-";
    study.timeName = "batch p50";
    study.moreNames = {"poses", "leaves", "spheres", "listed_pairs"};
    study.noDefault = "its rows are batches of different sizes";
    using Sizes = std::vector<std::pair<uint32_t, uint32_t>>;
    const bool quick = context.settings.quick;
    const Sizes sizes = quick ? Sizes{{64, 48}} : Sizes{{300, 200}, {640, 480}};
    for (const auto& [width, height] : sizes) {
        const WallRig rig(context.device, width, height);
        addRows(context, study, rig, quick ? std::vector<uint32_t>{16} : std::vector<uint32_t>{16, 256, 1024},
                quick ? std::vector<size_t>{1, 16} : std::vector<size_t>{1, 64, 256, 4096});
    }
    study.panels.push_back(batchPanel(study));
    concludeBatch(study);
    return study;
}

} // namespace fathom::profile
