// SPDX-License-Identifier: Apache-2.0
#include "apps/tune/tune_run.h"

#include "apps/binding/stop_signals.h"
#include "apps/clock/clock_keeper.h"
#include "apps/output/output_folder.h"
#include "apps/tune/tune_report.h"
#include "apps/tune/tune_words.h"
#include "apps/tune/tuned_scene.h"
#include "apps/verify/pressed_gripper.h"
#include "engine/run/open_scene.h"
#include "engine/types/error.h"
#include "engine/types/log.h"
#include "engine/types/version.h"

#include <iostream>
#include <yaml-cpp/yaml.h>

namespace fathom::tune {

namespace {

namespace fs = std::filesystem;

// The scene, which needs more than for a replay.
Scene sceneOf(const TuneSettings& settings) {
    Scene scene = openScene(settings.scene);
    if (!scene.hasForbiddenPoints()) {
        throw BadInput(settings.scene, "fixtures", "no forbidden class of points",
                       "at least one: its surface is what a hand feels");
    }
    const YAML::Node root = YAML::LoadFile(settings.scene);
    if (settings.source.empty() && !(root["camera"] && root["camera"]["source"])) {
        throw BadInput(settings.scene, "camera.source", "missing", "a camera in the scene, or --source");
    }
    return scene;
}

// The pilot's own value takes the place of haptics.friction.
std::string pilotsFriction(const Scene& scene, const std::string& file) {
    const YAML::Node root = YAML::LoadFile(file);
    for (const auto& pilot : root["pilots"] ? root["pilots"] : YAML::Node()) {
        if (pilot["name"].Scalar() == scene.pilot && pilot["friction"]) {
            return "the pilot '" + scene.pilot + "' has a friction of its own";
        }
    }
    return "";
}

// Why a setting has no effect for this scene and camera. That of the memory is in the words of the plan.
std::string whySkipped(Vary what, const Scene& scene, const CameraInfo& camera, const DeviceFacts& device) {
    if (what == Vary::Size && camera.decimation > 1) {
        return "the recording has no other pixels";
    }
    if (what != Vary::Memory) {
        return "";
    }
    Scene with = scene;
    with.filter.memory = 8;
    const Plan plan = makePlan(with, camera, 1, device);
    for (const Plan::Item& item : plan.items) {
        if (item.kind == "pass" && item.name == "estimate" && !item.in) {
            return item.why;
        }
    }
    return "";
}

std::string leftOut(const Plan& plan) {
    std::string text;
    for (const Plan::Item& item : plan.items) {
        if (item.kind == "pass" && !item.in) {
            text += (text.empty() ? "" : "; ") + item.name + " (" + item.why + ")";
        }
    }
    return text.empty() ? "nothing" : text;
}

// All that one run holds.
class TuneRun {
public:
    TuneRun(const TuneSettings& settings, const GlobalOptions& global)
        : settings_(settings)
        , scene_(sceneOf(settings))
        , old_(tunedSceneFile(scene_, settings.out))
        , instance_(global.validation())
        , device_(instance_, global.device)
        , clock_(global, device_.facts())
        , source_(tuneSource(
              scene_, settings.source.empty() ? std::nullopt : std::optional<fs::path>(settings.source),
              settings.frames))
        , tool_(toolOf(scene_)) {}

    int run() {
        const OutputLock lock(settings_.out);
        say();
        Tuner tuner(device_, source_, tool_, options());
        const TuneResult result = tuner.run();
        if (result.points.empty()) {
            throw Error("tune: ended by a signal before the first point; the output folder is as it was");
        }
        if (signals_.requested().load()) {
            log::warn("tune: ended by a signal after {} points", result.points.size());
        }
        for (const Trial& trial : result.trials) {
            if (!trial.skipped.empty()) {
                std::cout << "skipped   " << (trial.points.empty() ? "" : "some of ") << nameOf(trial.vary)
                          << ": " << trial.skipped << "\n";
            }
        }
        return write(result);
    }

private:
    static Tool toolOf(const Scene& scene) {
        const auto arm = openArm(scene);
        Tool tool = openTool(scene, arm.get());
        return tool.leafCount() > 0 ? std::move(tool) : Tool(buildSphereTree(gripperLeaves()));
    }

    void say() const {
        const Intrinsics& lens = source_.frames.camera.depth;
        std::cout << "scene     " << settings_.scene << "\ncamera    " << source_.camera << ", " << lens.width
                  << "x" << lens.height << "\ndevice    " << device_.facts().name << "\ntruth     "
                  << source_.judgedBy << "\nasked     " << settings_.request.text() << "\npoints    "
                  << source_.frames.frames.size() << " frames each; error of the felt surface, vibration "
                  << "of the force, time from camera to force" << std::endl;
    }

    TuneOptions options() const {
        TuneOptions options;
        options.request = settings_.request;
        options.limit = settings_.limit;
        const std::string friction = pilotsFriction(scene_, settings_.scene);
        options.skip = [this, friction](Vary what) {
            return what == Vary::Friction
                       ? friction
                       : whySkipped(what, source_.scene, source_.frames.camera, device_.facts());
        };
        options.stop = [this] { return signals_.requested().load(); };
        options.progress = [](size_t number, const TunePoint& point) {
            std::cout << lineOf(number, point) << std::endl;
        };
        return options;
    }

    int write(const TuneResult& result) const {
        const fs::path out(settings_.out);
        const std::optional<size_t> chosen = result.choice.point;
        OutputFile points(out / "points.csv"), curve(out / "tune.png");
        writePoints(result, settings_.request, points);
        curveOf(result, settings_.request,
                "Tuning of " + fs::path(settings_.scene).filename().string() + ": " +
                    settings_.request.text(),
                source_.camera + " · " + device_.facts().name + " · " +
                    (chosen ? "chosen: " + wordsOf(result.points[*chosen].setting) : "no point meets it"))
            .writePng(curve);
        OutputFile* const files[] = {&points, &curve};
        if (!chosen) {
            commitWithoutScene(files, old_); // an older scene must not outlive a run that finds none
            std::cerr << "fathom: tune: " << noneMeets(result, settings_.request) << "\n";
            std::cout << "written   " << points.path().string() << ", tune.png; no scene\n";
            return 1;
        }
        finish(result, result.points[*chosen], files);
        return 0;
    }

    void finish(const TuneResult& result, const TunePoint& chosen,
                std::span<OutputFile* const> others) const {
        const Plan plan = makePlan(sceneWith(scene_, chosen.setting), source_.frames.camera,
                                   static_cast<uint32_t>(tool_.leafCount()), device_.facts());
        std::string head =
            std::string(kWrittenBy) + " " + std::string(version()) + " for " + settings_.request.text() +
            " on " + device_.facts().name + "\nmeasured: " + valuesOf(chosen.score) +
            " from camera to force; as written before: " + valuesOf(result.points.front().score) +
            "\ncamera: " + source_.camera + "; judged by " + source_.judgedBy +
            "\nstability: " + stabilityOf(chosen) + "\nleft out: " + leftOut(plan);
        for (const Trial& trial : result.trials) {
            if (trial.points.empty()) { // of the others, the reason is at the key
                head += "\n" + reasonOf(result, trial, chosen);
            }
        }
        const fs::path file = writeTunedScene(scene_, chosen.setting, chosenValues(result, chosen), head,
                                              settings_.out, others);
        std::cout << "chosen    " << wordsOf(chosen.setting) << "\n          " << valuesOf(chosen.score)
                  << "; as written " << valuesOf(result.points.front().score) << "\nstability "
                  << stabilityOf(chosen) << "\nleft out  " << leftOut(plan) << "\nwritten   " << file.string()
                  << ", points.csv, tune.png\n";
    }

    const TuneSettings& settings_;
    Scene scene_;
    fs::path old_; // the scene of an earlier run
    gpu::Instance instance_;
    gpu::Device device_;
    ClockKeeper clock_;
    TuneSource source_;
    Tool tool_;
    StopSignals signals_; // last, because only the measurement asks for them
};

} // namespace

int runTune(const TuneSettings& settings, const GlobalOptions& global) {
    return TuneRun(settings, global).run();
}

} // namespace fathom::tune
