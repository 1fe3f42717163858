// SPDX-License-Identifier: Apache-2.0
#include "apps/replay/replay_session.h"

#include "apps/binding/approach_path.h"
#include "apps/binding/open_hand.h"
#include "apps/binding/open_source.h"
#include "devices/recorded/hand_csv.h"
#include "devices/simulated/simulated_hand.h"
#include "engine/haptics/hand_map.h"
#include "engine/types/error.h"

#include <cmath>

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

// Base-frame poses as the hand would make them: the inverse of hand.map before any clutch.
std::vector<HandWaypoint> toHand(std::vector<HandWaypoint> waypoints, const Scene::Hand& hand) {
    const dquat deviceRbase = glm::conjugate(hand.baseRdevice);
    for (HandWaypoint& w : waypoints) {
        w.deviceThandle.position = deviceRbase * w.deviceThandle.position / hand.scale;
        w.deviceThandle.rotation = deviceRbase * w.deviceThandle.rotation;
    }
    return waypoints;
}

// Lockstep has a clock of its own: a picture that comes when it comes has no place on it. What the camera's
// own corrections leave uncertain makes the scene's regions grow as a registration does.
std::unique_ptr<Camera> openReplayCamera(Scene& scene, const ReplayOptions& options) {
    auto camera = openCamera(
        scene, options.source.empty() ? std::nullopt : std::optional<std::filesystem::path>(options.source));
    if (camera->live() && !options.realtime) {
        throw BadInput("replay", "--source", camera->description(), "--realtime with a live camera");
    }
    scene.registrationSigma = std::hypot(scene.registrationSigma, camera->info().sigma);
    return camera;
}

} // namespace

ReplaySession::ReplaySession(const ReplayOptions& options, const GlobalOptions& global, uint32_t readers)
    : scene(sceneOf(options))
    , liveHand(options.handDevice.empty() ? nullptr : openLiveHand(options.handDevice, scene))
    , camera(openReplayCamera(scene, options))
    , arm(openArm(scene))
    , realArm(options.arm.empty() ? nullptr : openRealArm(scene, arm.get(), options.arm))
    , tool(openTool(scene, arm.get()))
    , cycles({instance, global.device, scene, camera->info(), tool, arm.get(), readers},
             [this](const DeviceFacts& facts) {
                 return makePlan(scene, camera->info(), static_cast<uint32_t>(tool.leafCount()), facts);
             }) {}

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

Pose startOf(const HandPath& path, const Scene& scene) {
    return HandMap(scene.hand.baseRdevice, scene.hand.scale).map(path.at(0.0).deviceThandle, false);
}

} // namespace fathom
