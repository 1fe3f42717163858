// SPDX-License-Identifier: Apache-2.0
#include "apps/session/session.h"

#include "apps/binding/approach_path.h"
#include "apps/binding/open_hand.h"
#include "apps/binding/open_source.h"
#include "apps/binding/raw_path.h"
#include "apps/output/progress.h"
#include "apps/session/repeated_camera.h"
#include "apps/session/shuttle_camera.h"
#include "engine/scene/dead_gates.h"
#include "engine/types/error.h"
#include "engine/types/log.h"
#include "shaders/shared/frame_params.h"

#include <algorithm>
#include <cstdio>
#include <utility>

namespace fathom {

namespace {

constexpr const char* kSpare = ""; // the name of a spare class; a scene file's names are never empty
constexpr size_t kShuttled = 48;   // frames of a simulated camera, repeated for ever

FixtureClass spareClass(Role role) {
    FixtureClass spare;
    spare.name = kSpare;
    spare.role = role;
    spare.hue = Band{0.0, 0.0};
    spare.box = Box{dvec3(1e6), dvec3(1e6)}; // far away, where no point can be
    return spare;
}

Scene sceneFor(const SessionOptions& options) {
    Scene scene = openScene(options.scene);
    if (!options.pilot.empty() && !scene.choosePilot(options.pilot)) {
        throw BadInput(scene.file.string(), "--pilot", options.pilot,
                       scene.pilots.empty() ? "none: the scene has no pilots" : scene.pilotNames());
    }
    if (!options.arm.empty()) {
        checkRealArm(scene, options.arm);
    }
    if (!options.query.empty()) {
        scene.contact.where =
            options.query == "cpu" ? Scene::Contact::Where::Cpu : Scene::Contact::Where::Gpu;
    }
    return scene;
}

SceneEdits editsFor(Scene& scene, const SessionOptions& options) {
    SceneEdits edits = takeEdits(scene, options.endless ? options.recording : options.source);
    if (options.endless) {
        scene = withSpareClasses(std::move(scene));
    }
    return edits;
}

std::optional<std::filesystem::path> given(const std::string& source) {
    return source.empty() ? std::nullopt : std::optional<std::filesystem::path>(source);
}

// Renders the frames of a simulated camera in advance, because rendering is slower than real time.
std::unique_ptr<Camera> shuttle(const Scene& scene, const std::atomic<bool>& stop) {
    if (scene.source.showsArm) {
        std::fprintf(
            stderr,
            "fathom: the frames of the simulated camera are rendered in advance: they do not show the arm\n");
    }
    Progress progress;
    return std::make_unique<ShuttleCamera>(
        openCamera(scene, std::nullopt), kShuttled, stop, [&progress](size_t taken) {
            progress.update({.framesDone = taken, .framesTotal = kShuttled, .framesOnly = true});
        });
}

std::unique_ptr<Camera> openAny(const Scene& scene, const SessionOptions& options,
                                const std::atomic<bool>& stop) {
    if (!options.recording.empty()) {
        return openCamera(scene, options.recording);
    }
    const auto source = given(options.source);
    if (!options.endless) {
        return openCamera(scene, source);
    }
    if (!source && scene.source.kind == CameraSource::Kind::Simulated) {
        return shuttle(scene, stop);
    }
    return std::make_unique<RepeatedCamera>([scene, source] { return openCamera(scene, source); });
}

// Rejects a live camera in lockstep, where its frames would have no time on the simulated clock.
std::unique_ptr<Camera> cameraFor(Scene& scene, const SessionOptions& options,
                                  const std::atomic<bool>& stop) {
    auto camera = openAny(scene, options, stop);
    if (camera->live() && !options.realtime) {
        throw BadInput("replay", "--source", camera->description(), "--realtime with a live camera");
    }
    takeUncertainty(scene, *camera);
    return camera;
}

bool needsDevice(const Scene& scene, const SessionWindow& window) {
    return scene.hasPoints() || window.drawing != gpu::Drawing::None;
}

std::string listed(const std::vector<int>& cpus) {
    std::string text;
    for (int cpu : cpus) {
        text.append(text.empty() ? "" : ",").append(std::to_string(cpu));
    }
    return text;
}

} // namespace

Scene withSpareClasses(Scene scene) {
    auto& rows = scene.fixtures;
    auto shapes =
        std::stable_partition(rows.begin(), rows.end(), [](const FixtureClass& f) { return f.isPoints(); });
    if (std::any_of(rows.begin(), shapes, isSpare)) {
        return scene; // a recording already has them
    }
    // One forbidden and one guidance class: together they bring every pass into the plan.
    for (Role role : {Role::Forbidden, Role::Guidance}) {
        if (static_cast<size_t>(shapes - rows.begin()) < shared::kMaxClasses) {
            shapes = rows.insert(shapes, spareClass(role)) + 1;
        }
    }
    return scene;
}

Session::Session(const SessionOptions& requested, const GlobalOptions& global, const SessionWindow& window,
                 const std::atomic<bool>& stop)
    : options(requested)
    , scene(sceneFor(options))
    , edits(editsFor(scene, options))
    , liveHand(options.handDevice.empty() ? nullptr : openLiveHand(options.handDevice, scene))
    , camera(cameraFor(scene, options, stop))
    , arm(openArm(scene))
    , realArm(options.arm.empty() ? nullptr : openRealArm(scene, *arm, options.arm))
    , tool(openTool(scene, arm.get()))
    , instance(needsDevice(scene, window)
                   ? std::make_unique<gpu::Instance>(global.validation(), window.extensions)
                   : nullptr)
    , cycles({instance.get(), global.device, scene, camera->info(), tool, arm.get(), window.drawing},
             [this](const DeviceFacts& facts) {
                 return options.endless || !edits.empty()
                            ? planToEdit(scene, camera->info(), tool, facts)
                            : makePlan(scene, camera->info(), static_cast<uint32_t>(tool.leafCount()), facts);
             })
    , passNames(cycles.frames().passNames())
    , handover(window.drawing != gpu::Drawing::None ? std::make_unique<DeviceHandover>() : nullptr)
    , answers(cycles) {
    clock = std::make_unique<ClockKeeper>(global, cycles.facts());
    edits.takeUncertainty(*camera);
    for (const auto& notes : {unusedKeys(scene), hueNotes(scene)}) {
        for (const std::string& note : notes) {
            log::warn("{}", note);
        }
    }
}

std::string describe(const ThreadPlacement& placement) {
    if (!placement.pinned()) {
        return "one CPU: the haptic thread shares it with everything else";
    }
    return "haptic on CPU " + listed(placement.haptic) + ", contact on " + listed(placement.contact) +
           ", camera, device workers and writer on " + listed(placement.rest);
}

std::string Session::title() const {
    return scene.file.stem().string() + ", " + camera->description();
}

std::string Session::where() const {
    const Plan::Query query = cycles.plan().query;
    return query == Plan::Query::None ? "none" : (query == Plan::Query::Cpu ? "cpu" : "gpu");
}

void Session::requireFrame(bool first) const {
    if (!first) {
        throw BadInput(camera->description(), "frames", "none usable", "at least one usable frame");
    }
}

ArmPosture Session::awaitArm(const std::atomic<bool>& stop) {
    const ArmPosture stands = realArm->ready(stop);
    arm->start = stands.q;
    return stands;
}

HandPath Session::path() {
    if (!options.operatorCsv.empty()) {
        return openHandPath(options.operatorCsv, scene, camera->info().poseless);
    }
    if (!scene.hand.builtIn) {
        return openHandPath(scene.hand.path, scene, camera->info().poseless);
    }
    if (approach_.empty()) {
        const auto first = cycles.frames().sets().newest();
        approach_ = approachPath(scene, tool, first->host, first->grid.get());
    }
    return HandPath(toHand(approach_, scene.hand));
}

const SceneEdit* Session::newEdit(uint32_t image) {
    const SceneEdit* edit = edits.empty() ? nullptr : &edits.at(image);
    return edit == std::exchange(edit_, edit) ? nullptr : edit;
}

} // namespace fathom
