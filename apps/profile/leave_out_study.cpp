// SPDX-License-Identifier: Apache-2.0
// What a scene gains by what it leaves out: each optional stage on and off, one at a time, from a scene that
// asks for everything.
#include "apps/profile/shot_source.h"
#include "apps/profile/studies.h"

#include <functional>

namespace fathom::profile {

namespace {

struct Stage {
    const char* name;
    std::function<void(Scene&, CameraInfo&)> leaveOut;
};

// Everything that a scene can ask for at once.
Scene fullScene(const Settings& settings) {
    Settings plain = settings;
    plain.source.clear();
    Scene scene = studyScene(plain);
    if (settings.scene.empty()) {
        scene.fixtures.front().box = Box{{-2.0, -2.0, 0.0}, {2.0, 2.0, 3.0}};
        scene.fixtures.back().largestPart = true;
        scene.contact.where = Scene::Contact::Where::Gpu;
    }
    return scene;
}

// The lens of TUM freiburg1, mild: rays come from a table then. Colour from a second camera beside the first.
CameraInfo fullCamera(CameraInfo camera) {
    camera.depth.distortion = {0.02, -0.03, 0.0005, 0.0003, 0.0};
    camera.colour = camera.depth;
    camera.registered = false;
    camera.colourTdepth.position = dvec3(0.0, 0.0, 0.0);
    return camera;
}

void dropClasses(Scene& scene, Role role) {
    std::erase_if(scene.fixtures, [&](const FixtureClass& f) { return f.isPoints() && f.role == role; });
}

std::vector<Stage> stages() {
    return {
        {"filter", [](Scene& s, CameraInfo&) { s.filter.radius = 0; }},
        {"flying pixels", [](Scene& s, CameraInfo&) { s.filter.edge = 0.0; }},
        {"thinning", [](Scene& s, CameraInfo&) { s.errorBudget = 0.0; }},
        {"hold", [](Scene& s, CameraInfo&) { s.holdSeconds = 0.0; }},
        {"guidance class", [](Scene& s, CameraInfo&) { dropClasses(s, Role::Guidance); }},
        {"forbidden class", [](Scene& s, CameraInfo&) { dropClasses(s, Role::Forbidden); }},
        {"largest part", [](Scene& s, CameraInfo&) { s.fixtures.back().largestPart = false; }},
        {"box", [](Scene& s, CameraInfo&) { s.fixtures.front().box.reset(); }},
        {"tree and slots for the GPU query",
         [](Scene& s, CameraInfo&) { s.contact.where = Scene::Contact::Where::Cpu; }},
        {"lens distortion", [](Scene&, CameraInfo& c) { c.depth.distortion = {}, c.colour.distortion = {}; }},
        {"colour registration", [](Scene&, CameraInfo& c) { c.registered = true; }},
    };
}

// A frame cycle whose result was compared with the twins before anything is timed.
std::unique_ptr<FrameBench> verified(const StudyContext& context, const Scene& scene,
                                     const CameraInfo& camera, const ShotSource& source,
                                     const std::string& name) {
    auto bench = std::make_unique<FrameBench>(context.device, scene, camera);
    bench->run(source.shots.front());
    const std::string wrong = bench->differsFromTwins(source.shots.front());
    verify(wrong.empty(), "leave_out", name, wrong + " differs from the float64 twin");
    return bench;
}

// The full frame and the one that leaves a stage out in turn, so that a change of the machine's mood hits
// both.
struct Pair {
    FrameCost full, less;
};
Pair measureInTurn(FrameBench& full, FrameBench& less, const ShotSource& source, const Effort& effort) {
    constexpr size_t kRounds = 5;
    const Effort part{(effort.least + kRounds - 1) / kRounds, effort.most, effort.seconds / kRounds};
    FrameSamples a, b;
    for (size_t round = 0; round < kRounds; ++round) {
        full.sample(source.shots, part, a);
        less.sample(source.shots, part, b);
    }
    return {full.costOf(a), less.costOf(b)};
}

StudyRow rowOf(const std::string& setting, const Pair& pair, double bytesSaved) {
    StudyRow row;
    row.source = "everything on";
    row.setting = setting;
    row.cost = pair.less.frame;
    const double saved = pair.full.total.p50 - pair.less.total.p50;
    row.more = {pair.less.total.p50, saved, 100.0 * saved / pair.full.total.p50,
                pair.full.frame.gpu.p50 - pair.less.frame.gpu.p50, bytesSaved / (1 << 20)};
    return row;
}

PlotPanel bars(const Study& study, size_t column, const std::string& title, const std::string& label) {
    PlotPanel panel{title, label, "", false, false, true, {}};
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
    study.title = "Leave out: what each optional stage costs a scene that asks for everything";
    study.verified = "class bits and points against the float64 twins where colour is registered";
    study.errorName = "error", study.errorUnit = "none";
    study.noDefault =
        "its rows are scenes that ask for less; what a scene does not ask for is left out by itself";
    study.timeName = "upload to published p50";
    study.moreNames = {"upload_to_published_p50_ms", "saved_ms", "share_of_frame_percent", "gpu_saved_ms",
                       "memory_saved_MiB"};
    const uint32_t w = context.settings.quick ? 320 : 640, h = context.settings.quick ? 240 : 480;
    const ShotSource source = analyticShots("tank", w, h, context.settings.quick ? 1 : 4);
    const Scene scene = fullScene(context.settings);
    const CameraInfo camera = fullCamera(source.camera);
    const auto full = verified(context, scene, camera, source, "nothing left out");
    const FrameCost alone = full->measure(source.shots, context.settings.effort());
    study.rows.push_back(rowOf("nothing left out", {alone, alone}, 0.0));
    for (const Stage& stage : stages()) {
        Scene fewer = scene;
        CameraInfo plainer = camera;
        stage.leaveOut(fewer, plainer);
        const auto less = verified(context, fewer, plainer, source, stage.name);
        const double bytes =
            static_cast<double>(bytesOf(full->plan())) - static_cast<double>(bytesOf(less->plan()));
        study.rows.push_back(
            rowOf(stage.name, measureInTurn(*full, *less, source, context.settings.effort()), bytes));
        const StudyRow& row = study.rows.back();
        study.findings.push_back(std::string("without ") + stage.name + ": " + digits(row.more[1]) +
                                 " ms less (" + digits(row.more[2]) + " % of the frame), " +
                                 digits(row.more[4]) + " MiB less");
    }
    study.panels.push_back(
        bars(study, 1, "time saved by leaving it out", "upload to published p50, saved [ms]"));
    study.panels.push_back(
        bars(study, 4, "memory saved by leaving it out", "buffers of the plan, saved [MiB]"));
    return study;
}

} // namespace fathom::profile
