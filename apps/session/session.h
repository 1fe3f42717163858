// SPDX-License-Identifier: Apache-2.0
// The objects of every run, built in order from one set of options: scene, hand, camera, arm, tool, device,
// plan, cycles.
#pragma once

#include "apps/binding/arm_thread.h"
#include "apps/binding/scene_edits.h"
#include "apps/clock/clock_keeper.h"
#include "apps/global_options.h"
#include "devices/camera.h"
#include "devices/live_hand.h"
#include "devices/simulated/hand_path.h"
#include "engine/cycle/device_cycles.h"
#include "engine/run/contact_loop.h"
#include "engine/run/cycle_answers.h"
#include "engine/run/device_handover.h"
#include "engine/run/thread_placement.h"

#include <atomic>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace fathom {

struct SessionOptions {
    std::filesystem::path scene;
    std::string source;      // recording folder or live camera; empty = the scene's camera
    std::string recording;   // folder that the window plays back; empty = none
    std::string operatorCsv; // hand path; empty = the scene's
    std::string handDevice;  // live hand (apps/binding/open_hand.h); empty = none
    std::string arm;         // serial port of the scene's real arm; empty = none
    std::string query;       // device of the contact query: cpu or gpu; empty = the scene's
    std::string pilot;       // name of one of the scene's pilots; empty = the scene's default
    bool realtime = true;    // false: lockstep, which rejects a live camera
    // The camera restarts when it ends, and spare classes let the pilot add fixtures while forces are on.
    bool endless = false;
};

// Vulkan requirements of the window that shares the device.
struct SessionWindow {
    gpu::Drawing drawing = gpu::Drawing::None;
    std::span<const char* const> extensions; // instance extensions
};

// Adds spare classes of points after the scene's own. A class that the pilot picks by colour takes one of
// them, so no buffer or pipeline changes while forces are on. A spare class selects no pixel. Shapes come
// after all classes, so that classes keep their rows when shapes are added or removed.
Scene withSpareClasses(Scene scene);

// Members are destroyed in reverse order, so owners are declared before their users.
struct Session {
    // stop: aborts the rendering of a simulated camera. Throws BadInput, Error, DeviceLost.
    Session(const SessionOptions& options, const GlobalOptions& global, const SessionWindow& window = {},
            const std::atomic<bool>& stop = kNeverStop);

    SessionOptions options;
    Scene scene;
    SceneEdits edits;                   // from a recording of the window
    std::unique_ptr<ClockKeeper> clock; // created after the device
    std::unique_ptr<LiveHand> liveHand; // null = no live hand
    std::unique_ptr<Camera> camera;
    std::unique_ptr<ArmSetup> arm;           // null = the tool moves freely
    std::unique_ptr<ArmThread> realArm;      // null = no real arm
    Tool tool;                               // with an arm: the tool at its tip
    std::unique_ptr<gpu::Instance> instance; // null: neither passes nor a window
    DeviceCycles cycles;
    std::vector<std::string> passNames; // also valid while the device is lost
    // Shares the device between frame thread and window; null = no window.
    std::unique_ptr<DeviceHandover> handover;
    CycleAnswers answers;

    // Null when the plan has no contact query.
    ContactAnswers* contacts() { return cycles.plan().query != Plan::Query::None ? &answers : nullptr; }
    std::string title() const; // scene and source
    std::string where() const; // device of the contact query: cpu, gpu, none
    // Throws BadInput when the source gave no first frame.
    void requireFrame(bool first) const;
    // Waits for the real arm, makes its posture the start of the scene's arm and returns it.
    ArmPosture awaitArm(const std::atomic<bool>& stop);
    // Raw hand path: the CSV of the options, the scene's, or the built-in path over the first fixture set.
    // The first call needs a fixture set; later calls return the same path.
    HandPath path();

    // The pilot's recorded edit that becomes active at this frame; null when nothing changed since the last
    // call.
    const SceneEdit* newEdit(uint32_t image);
    bool allFrozen() const { return edit_ != nullptr && edit_->allFrozen; }

private:
    std::vector<HandWaypoint> approach_; // base frame; kept because the fixture set may be gone later
    const SceneEdit* edit_ = nullptr;
};

// One line: the CPUs of the haptic thread and those of all others.
std::string describe(const ThreadPlacement& placement);

} // namespace fathom
