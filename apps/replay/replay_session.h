// SPDX-License-Identifier: Apache-2.0
// Everything a replay runs on, built in order from the options: scene, camera, tool, device, plan, cycles.
#pragma once

#include "apps/binding/arm_thread.h"
#include "apps/binding/scene_edits.h"
#include "apps/clock/clock_keeper.h"
#include "apps/replay/replay_command.h"
#include "devices/camera.h"
#include "devices/live_hand.h"
#include "devices/simulated/hand_path.h"
#include "engine/cycle/device_cycles.h"
#include "engine/types/haptic_device.h"

#include <memory>

namespace fathom {

// Owners before their borrowers: members are destroyed from the last to the first.
struct ReplaySession {
    // readers: leases on fixture sets held at once. Throws BadInput, Error, DeviceLost.
    ReplaySession(const ReplayOptions& options, const GlobalOptions& global, uint32_t readers);

    Scene scene;
    SceneEdits edits;                   // of a recording of the window
    std::unique_ptr<ClockKeeper> clock; // once there is a device
    std::unique_ptr<LiveHand> liveHand; // null = scripted or simulated
    std::unique_ptr<Camera> camera;
    std::unique_ptr<ArmRig> arm;        // null = the tool moves freely
    std::unique_ptr<ArmThread> realArm; // null = nothing but pictures moves
    Tool tool;                          // on an arm, what its tip carries
    gpu::Instance instance;
    DeviceCycles cycles;

    // What the pilot had changed from this picture on; null = nothing since the picture asked about before.
    const SceneEdit* newEdit(uint32_t image);
    bool heldStill() const { return edit_ != nullptr && edit_->still; } // all fixtures, in that picture

    std::string title() const; // scene, source
    std::string where() const; // of the contact query

private:
    const SceneEdit* edit_ = nullptr;
};

// The hand of a replay: the CSV that the options or the scene name, or the built-in path over the first
// fixture set.
HandPath openHandPath(const ReplaySession& session, const ReplayOptions& options,
                      const cloud::FixtureSet& firstSet);

// A device that follows the path; with --hand one that also feels the wrench.
std::unique_ptr<HapticDevice> openHand(const HandPath& path, const ReplaySession& session,
                                       const ReplayOptions& options);

} // namespace fathom
