// SPDX-License-Identifier: Apache-2.0
// Everything that the operator's window runs on, built in order: scene, camera, tool, device, plan, cycles.
#pragma once

#include "apps/binding/arm_thread.h"
#include "apps/operate/operate_command.h"
#include "devices/camera.h"
#include "devices/simulated/hand_path.h"
#include "engine/cycle/contact_cycle.h"
#include "engine/cycle/frame_cycle.h"

#include <atomic>
#include <memory>
#include <span>

namespace fathom::operate {

// The scene with spare classes of points behind its own: what the pilot picks by colour takes one of them, so
// that no buffer or pipeline changes while forces are on. A spare class marks no pixel.
Scene withSpareClasses(Scene scene);
bool isSpare(const FixtureClass& fixture);

// Owners before their borrowers.
struct OperateSession {
    // extensions: of the instance, for the window. Throws BadInput, Error, DeviceLost.
    OperateSession(const OperateOptions& options, const GlobalOptions& global, gpu::Drawing drawing,
                   std::span<const char* const> extensions, const std::atomic<bool>& stop);

    Scene scene; // with spare classes
    std::unique_ptr<Camera> camera;
    std::unique_ptr<ArmRig> arm;        // null = the tool moves freely
    std::unique_ptr<ArmThread> realArm; // null = nothing but pictures moves
    Tool tool;                          // on an arm, what its tip carries
    gpu::Instance instance;
    gpu::Device device;
    Plan plan;
    FrameCycle frames;
    ContactCycle contact;

    std::string title() const; // scene, source
    // Raw hand path of the scene over the first fixture set, as `replay` makes it.
    HandPath path() const;
};

} // namespace fathom::operate
