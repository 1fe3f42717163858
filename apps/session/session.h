// SPDX-License-Identifier: Apache-2.0
// What every run needs, built in order from one set of options: scene, hand, camera, arm, tool, device, plan,
// cycles.
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
    std::string arm;         // serial line of the scene's real arm; empty = none
    std::string query;       // cpu, gpu; empty = the scene's
    std::string pilot;       // one of the scene's pilots; empty = the one that the file names
    bool realtime = true;    // false: lockstep, which rejects a live camera
    // The camera restarts when it ends, and spare classes let the pilot add fixtures while forces are on.
    bool endless = false;
};

// The window's share of a session: what it draws with.
struct SessionWindow {
    gpu::Drawing drawing = gpu::Drawing::None;
    std::span<const char* const> extensions; // of the instance
};

inline const std::atomic<bool> kNeverStop{false};

// The scene with spare classes of points behind its own. A class that the pilot picks by colour takes one of
// them, so no buffer or pipeline changes while forces are on. A spare class marks no pixel. Shapes come after
// all classes, so that classes keep their rows when shapes are added or removed.
Scene withSpareClasses(Scene scene);

// Contact thread: answers over the newest fixture set.
class SessionAnswers final : public ContactAnswers {
public:
    explicit SessionAnswers(DeviceCycles& cycles)
        : cycles_(cycles) {}
    bool answer(const ToolState& place, ContactSet& out) override { return cycles_.answer(place, out); }

private:
    DeviceCycles& cycles_;
};

// Members are destroyed from the last to the first: owners stand before their borrowers.
struct Session {
    // stop: ends the rendering of a simulated camera's frames early. Throws BadInput, Error, DeviceLost.
    Session(const SessionOptions& options, const GlobalOptions& global, const SessionWindow& window = {},
            const std::atomic<bool>& stop = kNeverStop);

    SessionOptions options;
    Scene scene;
    SceneEdits edits;                   // of a recording that the window made
    std::unique_ptr<ClockKeeper> clock; // once there is a device
    std::unique_ptr<LiveHand> liveHand; // null = none
    std::unique_ptr<Camera> camera;
    std::unique_ptr<ArmRig> arm;        // null = the tool moves freely
    std::unique_ptr<ArmThread> realArm; // null = no real arm follows
    Tool tool;                          // on an arm: what its tip carries
    gpu::Instance instance;
    DeviceCycles cycles;
    std::vector<std::string> passNames;       // also while the device is lost
    std::unique_ptr<DeviceHandover> handover; // between frame thread and window; null = nothing draws
    SessionAnswers answers;

    // Null when the plan has no contact query.
    ContactAnswers* contacts() { return cycles.plan().query != Plan::Query::None ? &answers : nullptr; }
    std::string title() const; // scene and source
    std::string where() const; // of the contact query: cpu, gpu, none
    // Throws BadInput unless the source gave a first frame.
    void requireFrame(bool first) const;
    // Waits for the real arm and starts the scene's arm where it stands; returns that posture.
    ArmPosture awaitArm(const std::atomic<bool>& stop);
    // Raw hand path: the CSV of the options, that of the scene, or the built-in path over the first fixture
    // set. The first call needs a fixture set; later calls return the same path.
    HandPath path();

    // What the pilot changed from this frame on; null when nothing changed since the last call.
    const SceneEdit* newEdit(uint32_t image);
    bool heldStill() const { return edit_ != nullptr && edit_->still; } // all fixtures, in that frame

private:
    std::vector<HandWaypoint> approach_; // base frame; kept because its fixture set may be gone later
    const SceneEdit* edit_ = nullptr;
};

// The CPUs of the haptic thread and of all others, in one line.
std::string describe(const ThreadPlacement& placement);

} // namespace fathom
