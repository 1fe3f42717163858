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

// Pictures of one camera, and the same with the colour of a second one beside it.
struct Pictures {
    ShotSource registered, beside;
    const ShotSource& of(const CameraInfo& camera) const { return camera.registered ? registered : beside; }
};

// The lens of TUM freiburg1, mild, on both cameras: rays come from a table then.
CameraInfo fullCamera(CameraInfo camera) {
    camera.depth.distortion = {0.02, -0.03, 0.0005, 0.0003, 0.0};
    camera.colour = camera.depth;
    return camera;
}

void registerColour(CameraInfo& camera) {
    camera.registered = true;
    camera.colourTdepth = {};
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
        {"colour registration", [](Scene&, CameraInfo& c) { registerColour(c); }},
    };
}

// A frame cycle and its pictures, whose result was compared with the twins before anything is timed.
struct Verified {
    std::unique_ptr<FrameBench> bench;
    const std::vector<Shot>& shots;
};
Verified verified(const StudyContext& context, const Scene& scene, const CameraInfo& camera,
                  const Pictures& pictures, const std::string& name) {
    Verified v{std::make_unique<FrameBench>(context.device, scene, camera), pictures.of(camera).shots};
    v.bench->run(v.shots.front());
    const std::string wrong = v.bench->differsFromTwins(v.shots.front());
    verify(wrong.empty(), "leave_out", name, wrong + " differs from the float64 twin");
    const std::string sphere = v.bench->spheresDiffer();
    verify(sphere.empty(), "leave_out", name, sphere + " is not about a forbidden point of its own");
    return v;
}

// The full frame and the one that leaves a stage out in turn, so that a change of the machine's mood hits
// both.
struct Pair {
    FrameCost full, less;
};
Pair measureInTurn(const Verified& full, const Verified& less, const Effort& effort) {
    constexpr size_t kRounds = 5;
    const Effort part{(effort.least + kRounds - 1) / kRounds, effort.most, effort.seconds / kRounds};
    FrameSamples a, b;
    for (size_t round = 0; round < kRounds; ++round) {
        full.bench->sample(full.shots, part, a);
        less.bench->sample(less.shots, part, b);
    }
    return {full.bench->costOf(a), less.bench->costOf(b)};
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
    study.verified = "of every row: occlusion cells, class bits and points against the float64 twins, every "
                     "region sphere about a forbidden point of its own";
    study.errorName = "error", study.errorUnit = "none";
    study.noDefault =
        "its rows are scenes that ask for less; what a scene does not ask for is left out by itself";
    study.timeName = "upload to published p50";
    study.moreNames = {"upload_to_published_p50_ms", "saved_ms", "share_of_frame_percent", "gpu_saved_ms",
                       "memory_saved_MiB"};
    const uint32_t w = context.settings.quick ? 320 : 640, h = context.settings.quick ? 240 : 480;
    const uint32_t frames = context.settings.quick ? 1 : 4;
    const Pictures pictures{analyticShots("tank", w, h, frames), twoCameraShots("tank", w, h, frames)};
    const Scene scene = fullScene(context.settings);
    const CameraInfo camera = fullCamera(pictures.beside.camera);
    const Verified full = verified(context, scene, camera, pictures, "nothing left out");
    const FrameCost alone = full.bench->measure(full.shots, context.settings.effort());
    study.rows.push_back(rowOf("nothing left out", {alone, alone}, 0.0));
    for (const Stage& stage : stages()) {
        Scene fewer = scene;
        CameraInfo plainer = camera;
        stage.leaveOut(fewer, plainer);
        const Verified less = verified(context, fewer, plainer, pictures, stage.name);
        const double bytes = static_cast<double>(bytesOf(full.bench->plan())) -
                             static_cast<double>(bytesOf(less.bench->plan()));
        study.rows.push_back(rowOf(stage.name, measureInTurn(full, less, context.settings.effort()), bytes));
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
