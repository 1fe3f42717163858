// SPDX-License-Identifier: Apache-2.0
// Compares the steps of a frame, and the device's contact query, with the machine's limit: the unavoidable
// bytes and operations, divided by the measured bandwidth and arithmetic rate.
#include "apps/profile/ceilings.h"
#include "apps/profile/frame_sequence.h"
#include "apps/profile/query_limit.h"
#include "apps/profile/studies.h"
#include "engine/cloud/frame_params.h"
#include "shaders/shared/frame_params.h"

#include <algorithm>

namespace fathom::profile {

namespace {

// The minimum work of one step. Operations are float32, counted from the formulas of the pass.
struct Need {
    double bytes = 0.0, operations = 0.0;
    enum class Where { Device, Host, ThreadPool } where = Where::Device; // ThreadPool: the publishing threads
    double images = 0.0; // bytes read from the images' memory, not included in `bytes`
};

// The sizes of a frame that determine its minimum work.
struct Load {
    double pixels, slots, guidedSlots, selected, guided, spheres, packed, tapsPerPixel, cells,
        colourBytes; // counts; packed: bytes; colourBytes: bytes per pixel
    bool occlusion, hold, inPlace, pack, keepDepth, thin, thinsWithin, tree;
    QueryWork query; // of a query on the device; empty without one
};

// Class bits of all guidance classes.
uint32_t guidanceBits(const Scene& scene) {
    const std::vector<uint32_t> rows = cloud::classRows(scene);
    uint32_t bits = 0;
    for (size_t c = 0; c < rows.size(); ++c) {
        bits |= scene.fixtures[rows[c]].role == Role::Guidance ? 1u << c : 0u;
    }
    return bits;
}

Load loadOf(const FrameBench& bench, const FrameReport& report) {
    const auto masks = bench.masks();
    Load load{};
    load.pixels = static_cast<double>(masks.size());
    load.selected =
        static_cast<double>(std::count_if(masks.begin(), masks.end(), [](uint32_t m) { return m != 0; }));
    std::vector<uint8_t> listed(bench.cycle().layout().patches(), 0), guided(listed);
    const uint32_t width = bench.cycle().camera().depth.width, guidance = guidanceBits(bench.scene());
    for (uint32_t i = 0; i < masks.size(); ++i) {
        const uint32_t patch = slotOfPixel(i % width, i / width, bench.cycle().layout().across) / 256;
        const uint32_t guides = masks[i] & guidance;
        listed[patch] = std::max<uint8_t>(listed[patch], masks[i] != 0);
        guided[patch] = std::max<uint8_t>(guided[patch], guides != 0);
        load.guided += guides != 0 ? 1.0 : 0.0;
    }
    load.slots = 256.0 * static_cast<double>(std::count(listed.begin(), listed.end(), 1));
    load.guidedSlots = 256.0 * static_cast<double>(std::count(guided.begin(), guided.end(), 1));
    load.spheres = report.counts.spheres;
    const double edge = 2.0 * bench.plan().filterRadius + 1.0;
    load.tapsPerPixel = bench.plan().filterRadius > 0 ? edge * edge : 0.0;
    load.occlusion = bench.plan().occlusion;
    const cloud::WorkBuffers& work = bench.cycle().work();
    load.cells = load.occlusion ? static_cast<double>(work.cellsAcross) * work.cellsDown : 0.0;
    load.hold = bench.plan().hold;
    load.colourBytes = bench.colourBytesPerPixel();
    load.inPlace = report.inPlace;
    load.keepDepth = bench.plan().keepDepth;
    load.pack = bench.plan().pack;
    load.packed = 4.0 * bench.set().device.counters.as<shared::FrameCounters>()[0].packedWords;
    load.thin = bench.plan().thin;
    load.thinsWithin = load.thin && !bench.plan().thins();
    load.tree = bench.plan().tree;
    return load;
}

// Bytes of `spheres`: points, class bits, thinning and forbidden bits; with hold also the earlier points, the
// depth and the current points (nothing is held here, so the hold memory is not touched); then the output for
// a query or the host.
double sphereBytes(const Load& l) {
    const double hold = l.hold ? 16.0 + 2.0 + 16.0 : 0.0;
    const double layers = l.hold ? 2.0 : 1.0;
    const double radii = l.pack ? 0.0 : 4.0 * layers + 1.0;
    const double whole = l.tree ? 16.0 * layers + 20.0 / 16.0 : 0.0;
    return l.slots * (16.0 + 1.0 + (l.thin ? 1.0 : 0.0) + 0.25 + hold + radii + whole) +
           (l.pack ? l.packed + 72.0 / 256.0 * l.slots : 0.0);
}

// Reads the images in place or from upload memory. If an earlier pass has read the depth, its bytes count
// again, because that pass does not keep them.
Need classifyNeed(const Load& l) {
    Need need{l.pixels * ((l.keepDepth ? 2.0 : 0.0) + 1.0) + 4.0 * l.cells, 40.0 * l.pixels};
    need.images = l.pixels * (2.0 + l.colourBytes);
    return need;
}
Need occlusionNeed(const Load& l) {
    Need need{4.0 * l.cells, l.occlusion ? 40.0 * l.pixels : 0.0};
    need.images = l.occlusion ? 2.0 * l.pixels : 0.0;
    return need;
}

double thinOperations(const Load& l) {
    return l.slots / 16.0 * 25.0 * 45.0;
}

// Each buffer counts once, however often a pass reads it, as with a perfect cache.
std::vector<std::pair<std::string, Need>> needsOf(const Load& l) {
    return {
        {"upload",
         {l.inPlace ? 2.0 * sizeof(shared::FrameParams) : 2.0 * l.pixels * (2.0 + l.colourBytes), 0.0,
          Need::Where::Host}},
        {"occlusion", occlusionNeed(l)},
        {"classify", classifyNeed(l)},
        {"list", {l.pixels / 256.0 * (l.hold ? 8.0 : 4.0) + l.slots / 256.0 * (l.hold ? 8.0 : 4.0), 0.0}},
        {"surface", {l.slots * (1.0 + 2.0 + 16.0), l.selected * (70.0 + 20.0 * l.tapsPerPixel)}},
        {"thin", {l.slots * (1.0 + 16.0 + 1.0), thinOperations(l)}},
        {"spheres", {sphereBytes(l), 60.0 * l.slots + (l.thinsWithin ? thinOperations(l) : 0.0)}},
        {"tree", {l.slots / 16.0 * 20.0 * 17.0 / 16.0, l.slots / 16.0 * 30.0}},
        {"tree_query", {l.query.bytes, l.query.operations}},
        {"deliver", {3.0 * (sizeof(shared::FrameCounters) + 4.0 * l.pixels / 256.0), 0.0}},
        {"moments", {l.guidedSlots * (17.0 + 64.0 / 256.0), 40.0 * l.guided}},
        {"collect", // reads packed or plain device data, writes columns; reads of depths by points do not
                    // count
         {(l.pack ? l.packed : 20.0 * l.spheres) + 21.0 * l.spheres, 0.0, Need::Where::ThreadPool}},
        {"grid", {l.spheres * (16.0 + 20.0), 0.0, Need::Where::ThreadPool}},
    };
}

Spread spreadIn(const FrameCost& cost, const std::string& step) {
    if (step == "upload" || step == "collect" || step == "grid") {
        return step == "upload" ? cost.upload : step == "collect" ? cost.collect : cost.grid;
    }
    const auto it = cost.passes.find(step);
    return it != cost.passes.end() ? it->second : Spread{};
}

double bytesPerSecond(const Ceilings& c, Need::Where where) {
    return where == Need::Where::Device ? c.deviceBytes
           : where == Need::Where::Host ? c.hostBytes
                                        : c.workerBytes;
}

void addRows(Study& study, const std::string& source, const Load& load, const FrameCost& cost,
             const Ceilings& ceilings) {
    for (const auto& [step, need] : needsOf(load)) {
        const Spread time = spreadIn(cost, step);
        if (!time) {
            continue;
        }
        StudyRow row;
        row.source = source;
        row.setting = step;
        const bool onDevice = need.where == Need::Where::Device;
        (onDevice ? row.cost.gpu : row.cost.wall) = time; // several threads share host steps
        const double moving = need.images > 0.0 ? readingMs(ceilings, need.bytes, need.images, load.inPlace)
                                                : 1e3 * need.bytes / bytesPerSecond(ceilings, need.where);
        const double computing = onDevice ? need.operations / ceilings.deviceFlops * 1e3 : 0.0;
        // No pass is faster than an empty dispatch. A pass without work has no floor.
        const double work = std::max(moving, computing), dispatch = onDevice ? ceilings.dispatchMs : 0.0;
        const double floor = work > 0.0 ? std::max(work, dispatch) : 0.0,
                     ratio = floor > 0.0 ? time.p50 / floor : NAN;
        row.more = {(need.bytes + need.images) / 1e6, need.operations / 1e6, moving, computing, floor, ratio};
        study.rows.push_back(row);
        if (floor == 0.0) { // empty dispatch
            study.findings.push_back(source + ", " + step + ": " + digits(time.p50) + " ms, has no work");
            continue;
        }
        study.findings.push_back(source + ", " + step + ": " + digits(time.p50) + " ms, floor " +
                                 digits(floor) + " ms (" +
                                 (dispatch > work      ? "dispatch"
                                  : computing > moving ? "arithmetic"
                                                       : "bytes") +
                                 "), ratio " + digits(ratio));
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
    Scene asked = studyScene(settings);
    asked.contact.where = Scene::Contact::Where::Gpu;
    return {{"10 % forbidden", studyScene(settings), inYuyv(wallFrame(w, h, 0.1, WallNoise::Sensor))},
            {"100 % forbidden", studyScene(settings), inYuyv(wallFrame(w, h, 1.0, WallNoise::Sensor))},
            {"100 % forbidden, noise-free", studyScene(settings), inYuyv(wallFrame(w, h, 1.0))},
            {"two cameras, query on the device", asked, inYuyv(twoCameraFrames("tank", w, h, 1))}};
}

void sayCeilings(Study& study, const Ceilings& c) {
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
            const Spread& time = row.cost.gpu ? row.cost.gpu : row.cost.wall;
            (row.cost.gpu ? device : host)
                .points.push_back({row.more[5], 0.0, row.setting + (row.cost.gpu ? "" : " (host)"), false,
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
    Load load = loadOf(bench, report);
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
    study.errorName = "error", study.errorUnit = "none";
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
    sayCeilings(study, c);
    for (const LimitCase& each : limitCases(plain, w, h)) {
        addCase(context, each, c, study);
    }
    return study;
}

} // namespace fathom::profile
