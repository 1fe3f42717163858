// SPDX-License-Identifier: Apache-2.0
#include "apps/operate/operate_session.h"

#include "apps/binding/approach_path.h"
#include "apps/binding/open_hand.h"
#include "apps/binding/open_source.h"
#include "apps/binding/raw_path.h"
#include "apps/operate/repeating_camera.h"
#include "devices/recorded/hand_csv.h"
#include "engine/types/error.h"
#include "shaders/shared/frame_params.h"

#include <algorithm>
#include <cstdio>
#include <utility>

namespace fathom::operate {

namespace {

constexpr const char* kSpare = ""; // the name of a spare class; a scene file's names are never empty
constexpr size_t kShuttled = 48;   // pictures of a simulated camera
constexpr uint32_t kReaders = 2;   // feed, window's start

FixtureClass spareClass(Role role) {
    FixtureClass spare;
    spare.name = kSpare;
    spare.role = role;
    spare.hue = Band{0.0, 0.0};
    spare.box = Box{dvec3(1e6), dvec3(1e6)}; // no point is there
    return spare;
}

std::unique_ptr<Camera> openEndless(const Scene& scene, const OperateOptions& options,
                                    const std::atomic<bool>& stop) {
    if (!options.recording.empty()) { // once, and where one likes
        return openCamera(scene, options.recording);
    }
    const auto source =
        options.source.empty() ? std::nullopt : std::optional<std::filesystem::path>(options.source);
    if (!source && scene.source.kind == CameraSource::Kind::Simulated) {
        if (scene.source.showsArm) {
            std::fprintf(stderr,
                         "fathom: the simulated camera's pictures are taken beforehand: no arm in them\n");
        }
        auto camera =
            std::make_unique<ShuttleCamera>(openCamera(scene, source), kShuttled, stop, [](size_t taken) {
                std::fprintf(stderr, "\rfathom: rendering the simulated camera, picture %zu of %zu", taken,
                             kShuttled);
            });
        std::fprintf(stderr, "\n");
        return camera;
    }
    return std::make_unique<RepeatedCamera>([scene, source] { return openCamera(scene, source); });
}

std::unique_ptr<Camera> endless(Scene& scene, const OperateOptions& options, const std::atomic<bool>& stop) {
    auto camera = openEndless(scene, options, stop);
    takeUncertainty(scene, *camera);
    return camera;
}

// As the file has it, or with another pilot.
Scene sceneFor(const OperateOptions& options) {
    Scene scene = openScene(options.scene);
    if (!options.pilot.empty() && !scene.choosePilot(options.pilot)) {
        std::string names;
        for (const Scene::Pilot& pilot : scene.pilots) {
            names += (names.empty() ? "" : ", ") + pilot.name;
        }
        throw BadInput(scene.file.string(), "--pilot", options.pilot,
                       names.empty() ? "none: the scene has no pilots" : names);
    }
    return scene;
}

SceneEdits takeAll(Scene& scene, const std::string& recording) {
    SceneEdits edits = takeEdits(scene, recording);
    scene = withSpareClasses(std::move(scene));
    return edits;
}

} // namespace

Scene withSpareClasses(Scene scene) {
    auto& rows = scene.fixtures;
    auto shapes =
        std::stable_partition(rows.begin(), rows.end(), [](const FixtureClass& f) { return f.isPoints(); });
    if (std::any_of(rows.begin(), shapes, isSpare)) {
        return scene; // a recording's: it has them
    }
    // One forbidden and one guiding: together they put every pass into the plan.
    for (Role role : {Role::Forbidden, Role::Guidance}) {
        if (static_cast<size_t>(shapes - rows.begin()) < shared::kMaxClasses) {
            shapes = rows.insert(shapes, spareClass(role)) + 1;
        }
    }
    return scene;
}

OperateSession::OperateSession(const OperateOptions& options, const GlobalOptions& global,
                               gpu::Drawing drawing, std::span<const char* const> extensions,
                               const std::atomic<bool>& stop)
    : scene(sceneFor(options))
    , edits(takeAll(scene, options.recording))
    , liveHand(options.handDevice.empty() ? nullptr : openLiveHand(options.handDevice, scene))
    , camera(endless(scene, options, stop))
    , arm(openArm(scene))
    , realArm(options.arm.empty() ? nullptr : openRealArm(scene, arm.get(), options.arm))
    , tool(openTool(scene, arm.get()))
    , instance(global.validation(), extensions)
    , cycles({instance, global.device, scene, camera->info(), tool, arm.get(), kReaders, drawing},
             [this](const DeviceFacts& facts) { return planToEdit(scene, camera->info(), tool, facts); })
    , passNames(cycles.frames().passNames()) {
    clock = std::make_unique<ClockKeeper>(global, cycles.facts());
    edits.takeUncertainty(*camera);
}

std::string OperateSession::title() const {
    return scene.file.stem().string() + ", " + camera->description();
}

HandPath OperateSession::path() {
    if (!scene.hand.builtIn) {
        return HandPath(readHandCsv(scene.hand.path));
    }
    if (approach_.empty()) {
        const auto first = cycles.frames().sets().newest();
        approach_ = approachPath(scene, tool, first->host, first->grid);
    }
    return HandPath(toHand(approach_, scene.hand));
}

} // namespace fathom::operate
