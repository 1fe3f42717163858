// SPDX-License-Identifier: Apache-2.0
// Everything that the operator's window runs on, built in order: scene, camera, tool, device with its cycles.
#pragma once

#include "apps/binding/arm_thread.h"
#include "apps/binding/scene_edits.h"
#include "apps/clock/clock_keeper.h"
#include "apps/operate/operate_command.h"
#include "devices/camera.h"
#include "devices/live_hand.h"
#include "devices/simulated/hand_path.h"
#include "engine/cycle/device_cycles.h"
#include "engine/run/device_handover.h"

#include <atomic>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace fathom::operate {

// The scene with spare classes of points behind its own: what the pilot picks by colour takes one of them, so
// that no buffer or pipeline changes while forces are on. A spare class marks no pixel. Shapes are behind all
// of them: they come and go, and classes keep their rows.
Scene withSpareClasses(Scene scene);

// Owners before their borrowers.
struct OperateSession {
    // extensions: of the instance, for the window. Throws BadInput, Error, DeviceLost.
    OperateSession(const OperateOptions& options, const GlobalOptions& global, gpu::Drawing drawing,
                   std::span<const char* const> extensions, const std::atomic<bool>& stop);

    Scene scene;                        // with spare classes
    SceneEdits edits;                   // of a recording that is looked at
    std::unique_ptr<ClockKeeper> clock; // once there is a device
    std::unique_ptr<LiveHand> liveHand; // null = mouse and keyboard, or a path
    std::unique_ptr<Camera> camera;
    std::unique_ptr<ArmRig> arm;        // null = the tool moves freely
    std::unique_ptr<ArmThread> realArm; // null = nothing but pictures moves
    Tool tool;                          // on an arm, what its tip carries
    gpu::Instance instance;
    DeviceCycles cycles;
    DeviceHandover handover; // of their device, between the frame cadence and the window
    std::vector<std::string> passNames;

    std::string title() const; // scene, source
    // Raw hand path of the scene over the first fixture set, as `replay` makes it. Called first when there
    // is one.
    HandPath path();

private:
    std::vector<HandWaypoint> approach_; // base frame; kept, for what it was made over may be gone
};

} // namespace fathom::operate
