// SPDX-License-Identifier: Apache-2.0
// Compares the steps of a frame, and the device's contact query, with the machine's limit: the unavoidable
// bytes and operations, divided by the measured bandwidth and arithmetic rate.
#include "apps/profile/ceilings.h"
#include "apps/profile/frame_sequence.h"
#include "apps/profile/frame_work.h"
#include "apps/profile/query_limit.h"
#include "apps/profile/studies.h"

namespace fathom::profile {

namespace {

Spread spreadIn(const FrameCost& cost, const std::string& step) {
    if (step == "upload" || step == "collect" || step == "grid") {
        return step == "upload" ? cost.upload : step == "collect" ? cost.collect : cost.grid;
    }
    const auto it = cost.passes.find(step);
    return it != cost.passes.end() ? it->second : Spread{};
}

// Each row has one of the three.
const Spread& timeOf(const Cost& cost) {
    return cost.gpu ? cost.gpu : cost.wall ? cost.wall : cost.submit;
}

void addRow(Study& study, const std::string& source, const std::string& step, const Cost& cost,
            const StepWork& need, const StepFloor& floor) {
    StudyRow row;
    row.source = source;
    row.setting = step;
    row.cost = cost;
    const Spread& time = timeOf(cost);
    const double least = floor.least();
    row.more = {
        (need.bytes + need.across) / 1e6,    need.operations / 1e6, floor.moving, floor.computing, least,
        least > 0.0 ? time.p50 / least : NAN};
    study.rows.push_back(row);
    study.findings.push_back(source + ", " + step + ": " + digits(time.p50) + " ms, " +
                             (least == 0.0 ? "has no work" // empty dispatch
                                           : "floor " + digits(least) + " ms (" + floor.by() + "), ratio " +
                                                 digits(time.p50 / least)));
}

void addRows(Study& study, const std::string& source, const FrameLoad& load, const FrameCost& cost,
             const Ceilings& ceilings) {
    StepFloor passes{ceilings.submitMs};
    StepWork all;
    for (const auto& [step, need] : workOf(load)) {
        const Spread time = spreadIn(cost, step);
        if (!time) {
            continue;
        }
        const bool onDevice = need.where == StepWork::Where::Device;
        const StepFloor floor = floorOf(need, ceilings, load.inPlace);
        Cost timed;
        (onDevice ? timed.gpu : timed.wall) = time; // several threads share host steps
        addRow(study, source, step, timed, need, floor);
        if (cost.passes.count(step) != 0 && step != "tree_query") {
            passes.moving += floor.least();
            all.bytes += need.bytes + need.across;
            all.operations += need.operations;
        }
    }
    if (cost.frame.submit) { // each pass needs the one before
        Cost timed;
        timed.submit = cost.frame.submit;
        addRow(study, source, "submission and all passes", timed, all, passes);
    }
}

struct LimitCase {
    std::string name;
    Scene scene;
    FrameSequence images;
};
// A tenth of the image and all of it, with noise and without (thinning then keeps fewer points). Also the
// passes that such a scene lacks: colour from a second camera, and a tree for queries on the device. Colours
// are YUYV, as from USB cameras.
std::vector<LimitCase> limitCases(const Settings& settings, uint32_t w, uint32_t h) {
    Scene onDevice = studyScene(settings);
    onDevice.contact.where = Scene::Contact::Where::Gpu;
    std::vector<LimitCase> cases{
        {"10 % forbidden", studyScene(settings), inYuyv(wallFrame(w, h, 0.1, WallNoise::Sensor))},
        {"100 % forbidden", studyScene(settings), inYuyv(wallFrame(w, h, 1.0, WallNoise::Sensor))},
        {"100 % forbidden, noise-free", studyScene(settings), inYuyv(wallFrame(w, h, 1.0))},
        {"two cameras, query on the device", onDevice, inYuyv(twoCameraFrames("tank", w, h, 1))}};
    for (const auto& [name, share] :
         {std::pair("10 % forbidden, 1280x720", 0.1), {"100 % forbidden, 1280x720", 1.0}}) {
        if (!settings.quick) {
            cases.push_back(
                {name, studyScene(settings), inYuyv(wallFrame(1280, 720, share, WallNoise::Sensor))});
        }
    }
    return cases;
}

void reportCeilings(Study& study, const Ceilings& c) {
    study.findings.push_back(
        "device: its memory gives " + digits(c.deviceBytes * 1e-9) + " GB/s (read + written), it computes " +
        digits(c.deviceFlops * 1e-9) + " GFLOP/s, reads what the CPU writes at " +
        digits(c.uploadBytes * 1e-9) + " GB/s" +
        (c.importBytes > 0.0 ? " and the host's own pages at " + digits(c.importBytes * 1e-9) + " GB/s"
                             : std::string(" and cannot read the host's own pages")) +
        "; an empty dispatch takes " + digits(c.dispatchMs) + " ms of the device, an empty submission " +
        digits(c.submitMs) + " ms until its result is known");
    study.findings.push_back("host: copies " + digits(c.hostBytes * 1e-9) + " GB/s on one thread, " +
                             digits(c.workerBytes * 1e-9) + " on the " + std::to_string(c.hostThreads) +
                             " that publish (read + written)");
    study.findings.push_back(
        "ceilings: " + c.how +
        ", the host's copies of 64 MiB; a step whose data stay in a cache may be faster than its floor");
}

PlotPanel panelOf(const Study& study, const std::string& source) {
    PlotPanel panel{source + ": measured over floor",
                    "measured / floor (1 = cannot be faster)",
                    "",
                    true,
                    false,
                    true,
                    {}};
    PlotSeries device{"device", {}, false}, host{"host", {}, false};
    for (const StudyRow& row : study.rows) {
        if (row.source == source && !std::isnan(row.more[5])) {
            const Spread& time = timeOf(row.cost);
            (row.cost.wall ? host : device)
                .points.push_back({row.more[5], 0.0, row.setting + (row.cost.wall ? " (host)" : ""), false,
                                   false, time.p90 / row.more[4]});
        }
    }
    panel.series = {device, host};
    return panel;
}

// Adds rows for the passes of a frame and, if the plan has a tree, for a query of that frame's set.
void addCase(const StudyContext& context, const LimitCase& each, const Ceilings& ceilings, Study& study) {
    FrameBench bench(context.device, each.scene, each.images.camera);
    const SampleFrame& first = each.images.frames.front();
    const FrameReport report = bench.run(first);
    const std::string wrong = bench.differsFromTwins(first);
    verify(wrong.empty(), "limit", each.name, wrong + " differs from the float64 twin");
    FrameLoad load = loadOf(bench, report);
    const QueryLimit query = load.tree ? measureQuery(context, bench, first.baseTcamera) : QueryLimit{};
    load.query = query.least;
    FrameCost cost = bench.measure(each.images.frames, context.settings.repeats());
    cost.passes["tree_query"] = query.time;
    addRows(study, each.name, load, cost, ceilings);
    if (query.time) {
        study.findings.push_back(each.name + ", tree_query: " + std::to_string(query.leaves) +
                                 " leaves in touch, " + std::to_string(query.found) + " of " +
                                 std::to_string(query.spheres) +
                                 " spheres within 10 mm; its floor counts only the tests that lead to these");
    }
    study.panels.push_back(panelOf(study, each.name));
}

} // namespace

Study limitStudy(const StudyContext& context) {
    Study study;
    study.name = "limit";
    study.title = "Limit: steps of a frame, and a query, against what the machine allows";
    study.verified = "results of the bandwidth and compute measurements; class bits and points of a frame "
                     "against the float64 twins; the device's query against brute force";
    study.noDefault = "its rows are the steps of one frame and one query, at the default settings";
    study.timeName = "GPU time p50 of passes, wall time p50 of host steps";
    study.moreNames = {"MB_that_must_move", "million_operations", "moving_ms",
                       "computing_ms",      "floor_ms",           "ratio"};
    Settings plain = context.settings;
    plain.source.clear();
    const uint32_t w = plain.quick ? 320 : 640, h = plain.quick ? 240 : 480;
    const CameraInfo camera = wallFrame(w, h, 1.0).camera;
    const uint32_t publishers = makePlan(studyScene(plain), camera, 1, context.device.facts()).publishers;
    const Ceilings c = measureCeilings(context.device, publishers, context.settings.repeats());
    reportCeilings(study, c);
    for (const LimitCase& each : limitCases(plain, w, h)) {
        addCase(context, each, c, study);
    }
    return study;
}

} // namespace fathom::profile
