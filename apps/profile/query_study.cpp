// SPDX-License-Identifier: Apache-2.0
// Query time over tool leaves and region spheres for CPU, GPU and brute force. Finds the crossings that
// `where: auto` uses, and the cost of the reach with late answers.
#include "apps/profile/late_answers.h"
#include "apps/profile/query_crossings.h"
#include "apps/profile/studies.h"

#include "engine/gpu/query_crossover.h"

namespace fathom::profile {

namespace {

struct MethodLine {
    const char* method;
    const char* name;
    double dash;
};

// One line per method and set: time over the tool's leaves.
PlotPanel timePanel(const Study& study, const std::vector<std::string>& sources,
                    const std::vector<MethodLine>& methods, const RowValue& time) {
    PlotPanel panel;
    panel.xLabel = "tool leaves";
    for (const std::string& source : sources) {
        for (const MethodLine& line : methods) {
            PlotSeries series{std::string(line.name) + ", " + source, {}, true, line.dash, source};
            for (const StudyRow& row : study.rows) {
                if (row.source == source && isMethod(row, line.method) && time(row) > 0.0) {
                    series.points.push_back(
                        {row.more[kToolLeaves], time(row), "", false, false, NAN, p90Of(row, time(row))});
                }
            }
            panel.series.push_back(std::move(series));
        }
    }
    return panel;
}

void drawTimes(Study& study, const std::vector<std::string>& sources) {
    PlotPanel whole =
        timePanel(study, sources, {{kCpuMethod, "CPU", 0.0}, {kGpuMethod, "GPU", 9.0}}, submitTime);
    whole.title = "whole contact set: CPU solid, GPU dashed";
    whole.yLabel = "submission to result p50 [ms]";
    PlotPanel cull = timePanel(
        study, sources, {{kCpuMethod, "grid", 0.0}, {kGpuMethod, "tree", 9.0}, {kBruteMethod, "brute", 3.0}},
        cullTime);
    cull.title = "cull alone: CPU's grid solid, GPU's tree dashed, brute force dotted";
    cull.yLabel = "submission to result p50 [ms]";
    study.panels = {std::move(whole), std::move(cull)};
}

void concludeCrossings(const StudyContext& context, const std::vector<uint32_t>& tools, Study& study) {
    study.findings = crossingFindings(study.rows);
    DeviceFacts device = context.device.facts();
    std::string kept = "a quick run stores no crossover";
    if (!context.settings.quick) {
        device.gpuQueryLeaves = leavesForTheDevice(study.rows);
        kept = gpu::storeQueryCrossover(context.device.physical(), device.gpuQueryLeaves)
                   ? "stored for later runs on this device"
                   : "it could not be stored for later runs";
    }
    study.findings.push_back(autoDecision(device, tools) + " (" + kept + ")");
}

} // namespace

Study queryStudy(const StudyContext& context) {
    Study study;
    study.name = "query";
    study.title = "Query: time over tool leaves and region spheres, and the cost of the reach";
    study.verified = "contact sets of CPU and GPU equal to the last bit; culls equal to brute force; no leaf "
                     "enters a sphere in any run";
    study.errorName = "lag of the tool behind the hand RMS";
    study.errorUnit = "mm";
    study.timeName = "query p50";
    study.moreNames = queryColumnNames();
    const bool quick = context.settings.quick;
    using Sizes = std::vector<std::pair<uint32_t, uint32_t>>;
    const Sizes sizes =
        quick ? Sizes{{40, 30}, {128, 96}} : Sizes{{40, 25}, {128, 80}, {300, 200}, {640, 480}, {1280, 800}};
    const std::vector<uint32_t> tools =
        quick ? std::vector<uint32_t>{1, 64, 1000} : std::vector<uint32_t>{1, 4, 16, 64, 256, 1024, 4096};
    std::vector<std::string> sources;
    for (const auto& [width, height] : sizes) {
        for (StudyRow& row : queryRows(context, width, height, tools)) {
            study.rows.push_back(std::move(row));
        }
        sources.push_back(study.rows.back().source);
    }
    for (StudyRow& row : fewSphereRows(context)) {
        study.rows.push_back(std::move(row));
    }
    concludeCrossings(context, tools, study);
    drawTimes(study, sources);
    addLateAnswers(context, study);
    return study;
}

} // namespace fathom::profile
