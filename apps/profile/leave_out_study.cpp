// SPDX-License-Identifier: Apache-2.0
// Measures the savings of each optional stage: switches one stage off at a time in a scene that enables
// everything.
#include "apps/profile/device_stream.h"
#include "apps/profile/frame_sequence.h"
#include "apps/profile/studies.h"

#include <functional>
#include <limits>
#include <optional>

namespace fathom::profile {

namespace {

// A scene, its camera, and options outside the scene file.
struct Setup {
    Scene scene;
    CameraInfo camera;
    bool selfFilter = true; // removes the arm's points from the cloud
    bool still = false;     // the camera has no new frame
    bool passTimes = true;  // the device's clock times each pass
};

struct Stage {
    const char* name;
    std::function<void(Setup&)> leaveOut;
    std::function<void(Setup&)> before = {}; // changes the full setup first, if set
};

// A scene with all stages enabled.
Scene fullScene(const Settings& settings) {
    Settings plain = settings;
    plain.source.clear();
    Scene scene = studyScene(plain);
    if (settings.scene.empty()) {
        scene.fixtures.front().box = Box{{-2.0, -2.0, 0.0}, {2.0, 2.0, 3.0}};
        scene.fixtures.back().largestPart = true;
        scene.fixtures.back().trim = 0.1;
        scene.contact.where = Scene::Contact::Where::Gpu;
    }
    return scene;
}

// An arm of 64 spheres in front of the left of the image.
cloud::ArmSpheres armInView() {
    cloud::ArmSpheres arm;
    for (uint32_t i = 0; i < 64; ++i) {
        const uint32_t across = i % 8, down = i / 8;
        arm.spheres.push_back({dvec3(-0.25 + 0.02 * across, -0.2 + 0.05 * down, 0.75), 0.04});
        if (i % 16 == 15) {
            arm.ends.push_back(i + 1);
        }
    }
    return arm;
}

// Frames of one camera, and the same with colour from a second one next to it.
struct Images {
    FrameSequence registered, beside;
    const FrameSequence& of(const CameraInfo& camera) const {
        return camera.registered ? registered : beside;
    }
};

// Gives both cameras a mild version of the TUM freiburg1 lens distortion, so that rays come from a table.
CameraInfo fullCamera(CameraInfo camera) {
    camera.depth.distortion = {0.02, -0.03, 0.0005, 0.0003, 0.0};
    camera.colour = camera.depth;
    camera.colourFormat = ColourFormat::Rgba; // a separate stage measures it
    return camera;
}

void registerColour(CameraInfo& camera) {
    camera.registered = true;
    camera.colourTdepth = {};
}

void dropClasses(Scene& scene, Role role) {
    std::erase_if(scene.fixtures, [&](const FixtureClass& f) { return f.isPoints() && f.role == role; });
}

// Colour gates that accept everything, so that both variants select the same points.
void gateNothing(Setup& s) {
    registerColour(s.camera);
    for (FixtureClass& f : s.scene.fixtures) {
        f.hue.reset();
        f.saturation.reset();
        f.lightness = Band{0.0, 0.9999};
    }
}
void dropColour(Setup& s) {
    for (FixtureClass& f : s.scene.fixtures) {
        f.lightness.reset();
    }
}

void dropGuidancePoints(Setup& s) {
    for (FixtureClass& f : s.scene.fixtures) {
        f.largestPart = false;
        f.trim = 0.0;
    }
}

std::vector<Stage> stages() {
    return {
        {"filter", [](Setup& s) { s.scene.filter.radius = 0; }},
        {"flying pixels", [](Setup& s) { s.scene.filter.edge = 0.0; }},
        {"isolated pixels", [](Setup& s) { s.scene.filter.isolated = false; }},
        {"thinning", [](Setup& s) { s.scene.errorBudget = 0.0; }},
        {"hold", [](Setup& s) { s.scene.holdSeconds = 0.0; }},
        {"guidance class", [](Setup& s) { dropClasses(s.scene, Role::Guidance); }},
        {"forbidden class", [](Setup& s) { dropClasses(s.scene, Role::Forbidden); }},
        {"largest part", [](Setup& s) { s.scene.fixtures.back().largestPart = false; }},
        {"trimmed mean", [](Setup& s) { s.scene.fixtures.back().trim = 0.0; }},
        {"guidance points on the host (both)", dropGuidancePoints},
        {"box", [](Setup& s) { s.scene.fixtures.front().box.reset(); }},
        {"tree and slots for the GPU query",
         [](Setup& s) { s.scene.contact.where = Scene::Contact::Where::Cpu; }},
        {"lens distortion",
         [](Setup& s) { s.camera.depth.distortion = {}, s.camera.colour.distortion = {}; }},
        {"colour registration", [](Setup& s) { registerColour(s.camera); }},
        {"colour, of gates that pass all", dropColour, gateNothing},
        {"half of colour's bytes (YUYV instead of RGBA)",
         [](Setup& s) { s.camera.colourFormat = ColourFormat::Yuyv; },
         [](Setup& s) { registerColour(s.camera); }},
        {"self-filter", [](Setup& s) { s.selfFilter = false; }},
        {"repeated frame", [](Setup& s) { s.still = true; }},
        {"times of passes", [](Setup& s) { s.passTimes = false; }},
    };
}

// A frame cycle and its frames. Its result has been compared with the twins before any timing.
struct Verified {
    std::unique_ptr<FrameBench> bench;
    const std::vector<SampleFrame>& frames;
    double heap = 0.0; // [bytes] of a second instance, with pipelines already compiled
};

std::unique_ptr<FrameBench> benchOf(const StudyContext& context, const Setup& setup) {
    const auto change = [&](Plan& plan) {
        plan.selfFilter = setup.selfFilter;
        plan.passTimes = setup.passTimes;
    };
    auto bench = std::make_unique<FrameBench>(context.device, setup.scene, setup.camera, change);
    bench->setArm(armInView());
    return bench;
}

double heapOf(const StudyContext& context, const Setup& setup, const std::vector<SampleFrame>& frames) {
    const auto before = static_cast<double>(heapBytes());
    const auto bench = benchOf(context, setup);
    bench->run(frames.front());
    return static_cast<double>(heapBytes()) - before;
}

Verified verified(const StudyContext& context, const Setup& setup, const Images& images,
                  const std::string& name) {
    Verified v{benchOf(context, setup), images.of(setup.camera).frames};
    v.bench->run(v.frames.front());
    const std::string wrong = v.bench->differsFromTwins(v.frames.front());
    verify(wrong.empty(), "leave_out", name, wrong + " differs from the float64 twin");
    const std::string sphere = v.bench->spheresDiffer();
    verify(sphere.empty(), "leave_out", name, sphere + " is not around its own forbidden point");
    const std::string pose = v.bench->guidanceDiffers();
    verify(pose.empty(), "leave_out", name, pose + " differs from the float64 twin");
    v.heap = heapOf(context, setup, v.frames);
    if (setup.still) {
        v.bench->holdStill();
    }
    return v;
}

// The full setup and the one without a stage, measured alternately so that machine drift affects both
// equally.
struct Pair {
    FrameCost full, less;
};
Pair measureAlternating(const Verified& full, const Verified& less, const Repeats& repeats) {
    constexpr size_t kRounds = 5;
    const Repeats part{(repeats.least + kRounds - 1) / kRounds, repeats.most, repeats.seconds / kRounds};
    FrameSamples a, b;
    for (size_t round = 0; round < kRounds; ++round) {
        full.bench->sample(full.frames, part, a);
        less.bench->sample(less.frames, part, b);
    }
    return {full.bench->costOf(a), less.bench->costOf(b)};
}

// Device time saved [ms]. NaN if the passes were not timed; the full time if no pass ran.
double gpuSaved(const Pair& pair) {
    const Spread &full = pair.full.frame.gpu, &less = pair.less.frame.gpu;
    if (full.count == 0 || (less.count == 0 && pair.less.frame.submit.count > 0)) {
        return std::numeric_limits<double>::quiet_NaN();
    }
    return less.count == 0 ? full.p50 : full.p50 - less.p50;
}

StudyRow rowOf(const std::string& setting, const Pair& pair, double bytesSaved, double heapSaved) {
    constexpr double kMiB = 1 << 20;
    StudyRow row;
    row.source = "everything on";
    row.setting = setting;
    row.cost = pair.less.frame;
    const double saved = pair.full.total.p50 - pair.less.total.p50;
    row.more = {pair.less.total.p50, saved,           100.0 * saved / pair.full.total.p50, gpuSaved(pair),
                bytesSaved / kMiB,   heapSaved / kMiB};
    return row;
}

StudyRow stageRow(const StudyContext& context, const Stage& stage, const Verified& full, const Setup& setup,
                  const Images& images) {
    Setup less = setup;
    std::optional<Verified> own; // for stages with their own baseline
    if (stage.before) {
        stage.before(less);
        own.emplace(verified(context, less, images, stage.name));
    }
    stage.leaveOut(less);
    const Verified& from = own ? *own : full;
    const Verified without = verified(context, less, images, stage.name);
    const Pair pair = measureAlternating(from, without, context.settings.repeats());
    const double bytes = static_cast<double>(bytesOf(from.bench->plan())) -
                         static_cast<double>(bytesOf(without.bench->plan()));
    return rowOf(stage.name, pair, bytes, from.heap - without.heap);
}

void sayRow(Study& study, const StudyRow& row) {
    study.findings.push_back("without " + row.setting + ": " + digits(row.more[1]) + " ms less (" +
                             digits(row.more[2]) + " % of the frame), " + digits(row.more[4]) +
                             " MiB less of the plan's buffers, " + digits(row.more[5]) + " MiB of heap");
}

PlotPanel bars(const Study& study, size_t column, const std::string& title, const std::string& label) {
    PlotPanel panel{title, label, "", false, false, true, {}, true};
    PlotSeries series;
    for (size_t i = 1; i < study.rows.size(); ++i) {
        series.points.push_back({study.rows[i].more[column], 0.0, study.rows[i].setting, false, false});
    }
    panel.series.push_back(std::move(series));
    return panel;
}

} // namespace

Study leaveOutStudy(const StudyContext& context) {
    Study study;
    study.name = "leave_out";
    study.title = "Leave out: what each optional stage costs a scene that uses all of them";
    study.verified = "every row: occlusion cells, class bits, points and guidance against the float64 twins; "
                     "every region sphere is around its own forbidden point";
    study.noDefault = "its rows are scenes with fewer features; the plan skips what a scene does not use";
    study.timeName = "upload to published p50";
    study.moreNames = {"upload_to_published_p50_ms", "saved_ms",
                       "share_of_frame_percent",     "gpu_saved_ms",
                       "memory_saved_MiB",           "heap_saved_MiB"};
    const uint32_t w = context.settings.quick ? 320 : 640, h = context.settings.quick ? 240 : 480;
    const uint32_t frames = context.settings.quick ? 1 : 4;
    const Images images{inYuyv(analyticFrames("tank", w, h, frames)),
                        inYuyv(twoCameraFrames("tank", w, h, frames))};
    const Setup setup{fullScene(context.settings), fullCamera(images.beside.camera)};
    const Verified full = verified(context, setup, images, "nothing left out");
    const FrameCost alone = full.bench->measure(full.frames, context.settings.repeats());
    study.rows.push_back(rowOf("nothing left out", {alone, alone}, 0.0, 0.0));
    for (const Stage& stage : stages()) {
        study.rows.push_back(stageRow(context, stage, full, setup, images));
        sayRow(study, study.rows.back());
    }
    study.findings.push_back(
        std::string("heap: what malloc gave the cycle and its sets, the host's copies and grids among it; ") +
        (oneMemory(context.device) ? "this device's buffers are there, too" : "no buffer of the device"));
    study.panels.push_back(
        bars(study, 1, "time saved by leaving it out", "upload to published p50, saved [ms]"));
    study.panels.push_back(
        bars(study, 4, "memory saved by leaving it out", "buffers of the plan, saved [MiB]"));
    study.panels.push_back(bars(study, 5, "heap saved by leaving it out", "the program's heap, saved [MiB]"));
    return study;
}

} // namespace fathom::profile
