// SPDX-License-Identifier: Apache-2.0
#include "apps/replay/replay_session.h"

#include "apps/binding/approach_path.h"
#include "apps/binding/open_hand.h"
#include "apps/binding/open_source.h"
#include "apps/binding/raw_path.h"
#include "devices/recorded/hand_csv.h"
#include "devices/simulated/simulated_hand.h"
#include "engine/types/error.h"

#include <utility>

namespace fathom {

namespace {

Scene sceneOf(const ReplayOptions& options) {
    Scene scene = openScene(options.scene);
    if (options.query == "cpu") {
        scene.contact.where = Scene::Contact::Where::Cpu;
    } else if (options.query == "gpu") {
        scene.contact.where = Scene::Contact::Where::Gpu;
    }
    return scene;
}

// Lockstep has a clock of its own: a picture that comes when it comes has no place on it.
std::unique_ptr<Camera> openReplayCamera(Scene& scene, const ReplayOptions& options) {
    auto camera = openCamera(
        scene, options.source.empty() ? std::nullopt : std::optional<std::filesystem::path>(options.source));
    if (camera->live() && !options.realtime) {
        throw BadInput("replay", "--source", camera->description(), "--realtime with a live camera");
    }
    takeUncertainty(scene, *camera);
    return camera;
}

} // namespace

ReplaySession::ReplaySession(const ReplayOptions& options, const GlobalOptions& global, uint32_t readers)
    : scene(sceneOf(options))
    , edits(takeEdits(scene, options.source))
    , liveHand(options.handDevice.empty() ? nullptr : openLiveHand(options.handDevice, scene))
    , camera(openReplayCamera(scene, options))
    , arm(openArm(scene))
    , realArm(options.arm.empty() ? nullptr : openRealArm(scene, arm.get(), options.arm))
    , tool(openTool(scene, arm.get()))
    , instance(global.validation())
    , cycles({instance, global.device, scene, camera->info(), tool, arm.get(), readers},
             [this](const DeviceFacts& facts) {
                 return edits.empty()
                            ? makePlan(scene, camera->info(), static_cast<uint32_t>(tool.leafCount()), facts)
                            : planToEdit(scene, camera->info(), tool, facts);
             }) {
    clock = std::make_unique<ClockKeeper>(global, cycles.facts());
    edits.takeUncertainty(*camera);
}

const SceneEdit* ReplaySession::newEdit(uint32_t image) {
    const SceneEdit* edit = edits.empty() ? nullptr : &edits.at(image);
    return edit == std::exchange(edit_, edit) ? nullptr : edit;
}

std::string ReplaySession::title() const {
    return scene.file.stem().string() + ", " + camera->description();
}

std::string ReplaySession::where() const {
    const Plan::Query query = cycles.plan().query;
    return query == Plan::Query::None ? "none" : (query == Plan::Query::Cpu ? "cpu" : "gpu");
}

HandPath openHandPath(const ReplaySession& session, const ReplayOptions& options,
                      const cloud::FixtureSet& firstSet) {
    if (!options.operatorCsv.empty()) {
        return HandPath(readHandCsv(options.operatorCsv));
    }
    if (!session.scene.hand.builtIn) {
        return HandPath(readHandCsv(session.scene.hand.path));
    }
    return HandPath(
        toHand(approachPath(session.scene, session.tool, firstSet.host, firstSet.grid), session.scene.hand));
}

std::unique_ptr<HapticDevice> openHand(const HandPath& path, const ReplaySession& session,
                                       const ReplayOptions& options) {
    if (!options.hand) {
        return std::make_unique<ScriptedHand>(path);
    }
    SimulatedHandOptions loop;
    loop.loop = session.scene.hand.loop;
    loop.delayTicks = session.scene.haptics.delay;
    return std::make_unique<SimulatedHand>(path, loop);
}

} // namespace fathom
