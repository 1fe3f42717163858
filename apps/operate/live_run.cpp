// SPDX-License-Identifier: Apache-2.0
#include "apps/operate/live_run.h"

#include "apps/binding/raw_path.h"
#include "apps/operate/arming.h"
#include "engine/cycle/start_notes.h"
#include "engine/types/error.h"
#include "engine/types/log.h"

#include <chrono>
#include <limits>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <thread>
#include <unistd.h>

namespace fathom::operate {

namespace {

constexpr int kNiceness = 5; // lowers the window thread's priority below camera and contacts

ButtonBits nativeButtons(const Scene& scene) {
    return {kGuidanceButton, scene.hand.clutchBit, scene.arm ? scene.arm->grasp.button : 0};
}

// With the slow rise of forces of a pilot's run.
HapticOptions softStartOptions(const Session& session) {
    HapticOptions options = makeHapticOptions(session.scene, session.tool);
    options.softStartTime = softStart(options.forceLimit);
    return options;
}

} // namespace

LiveRun::LiveRun(const OperateOptions& options, Session& session, const StopSignals& signals,
                 const ThreadPlacement& placement, RunSink& sink, RunObserver& observers)
    : options_(options)
    , session_(session)
    , signals_(signals)
    , placement_(placement)
    , sink_(sink)
    , observers_(observers)
    , haptics_(softStartOptions(session))
    , buttons_(nativeButtons(session.scene))
    , feed_(session) {
    if (session.liveHand) {
        buttons_.load(buttonFile(session.scene.file));
    }
}

HandDeviceFacts LiveRun::device() const {
    return {session_.liveHand ? session_.liveHand->description() : "", hand_->present(), hand_->buttonsDown(),
            &buttons_};
}

void LiveRun::mapButtons(Console& console) {
    std::optional<ButtonUse>& mapping = console.editing.mapping;
    const uint32_t pressed = hand_->takePressed() & ~kDeadManOpen;
    mappedStillDown_ = mappedStillDown_ && (hand_->buttonsDown() & ~kDeadManOpen) != 0;
    hand_->capture(mapping || mappedStillDown_);
    if (!mapping || pressed == 0) {
        return;
    }
    const ButtonUse use = *mapping;
    mapping.reset();
    mappedStillDown_ = true;
    const std::string fault = buttons_.choose(use, pressed);
    if (!fault.empty()) {
        console.notify(fault);
        return;
    }
    hand_->choose(buttons_.chosen());
    const auto file = buttonFile(session_.scene.file);
    const std::string words =
        std::string(buttonUseName(use)) + " is button " + std::to_string(buttonNumber(pressed));
    try {
        buttons_.save(file);
        console.notify(words + ", saved to " + file.string());
    } catch (const Error& e) {
        console.notify(words + " until the end: " + e.what());
    }
}

HapticDevice& LiveRun::driver() {
    if (session_.liveHand) {
        return *session_.liveHand;
    }
    return options_.path ? static_cast<HapticDevice&>(*path_) : *pilot_;
}

// Creates the hand. start: raw pose of a hand that the window moves. tool: where the tool stays; null = at
// the start of the path. A live hand may be at any pose, and may not be connected yet.
void LiveRun::makeHand(const std::vector<Shape>& shapes, const Pose& start, const Pose* tool) {
    const HandPath path = session_.path();
    const LiveHand* live = session_.liveHand.get();
    const Pose place = tool != nullptr ? *tool : startOf(path, session_.scene);
    Pose raw = tool != nullptr ? start : path.waypoints().front().deviceThandle;
    pilot_ = std::make_unique<PilotHand>(raw);
    path_ = std::make_unique<PathHand>(path);
    hand_ = std::make_unique<GatedHand>(driver(), live, buttons_.native(), signals_.requested());
    hand_->choose(buttons_.chosen());
    steering_ = std::make_unique<Steering>(raw, session_.scene.hand);
    raw = live != nullptr ? hand_->read(0.0).deviceThandle : raw;
    const bool anywhere = live != nullptr || (session_.arm && !options_.path); // the hand may start elsewhere
    cycle_ =
        std::make_unique<HapticCycle>(session_.tool, shapes, haptics_, raw,
                                      tool != nullptr || anywhere ? &place : nullptr, session_.arm.get());
    start_ = cycle_->place();
}

void LiveRun::makeEngine(const std::vector<Shape>& shapes, const Pose& start, const Pose* tool) {
    RealtimeOptions o;
    o.placement = placement_;
    o.hapticPeriod = haptics_.period;
    o.warnWhenStale = false; // the window reports it
    if (session_.realArm) {
        if (engine_ == nullptr) {
            session_.awaitArm(signals_.requested());
        }
        o.arm = &session_.realArm->link();
    }
    observers_.forget(); // their set belongs to the previous run
    observers_.setShapes(shapes);
    engine_ = std::make_unique<RealtimeRun>(feed_, session_.contacts(), o);
    feed_.begin();
    awaitFrame();
    makeHand(shapes, start, tool);
}

// A camera that is lost at a change of pilot does not end the window, with edits that are not saved.
void LiveRun::awaitFrame() {
    constexpr auto kPause = std::chrono::milliseconds(200);
    for (;;) {
        try {
            session_.requireFrame(engine_->firstFrame());
            return;
        } catch (const DeviceLost& e) {
            if (thread_ == nullptr || signals_.requested().load()) {
                throw;
            }
            log::warn("camera is gone ({}): the new run waits for it", e.what());
            std::this_thread::sleep_for(kPause);
        }
    }
}

void LiveRun::start(const std::vector<Shape>& shapes) {
    makeEngine(shapes, {}, nullptr);
    thread_ = std::make_unique<RunThread>([this](const std::atomic<bool>& stop) {
        engine_->run(*cycle_, *hand_, std::numeric_limits<double>::infinity(), sink_, stop);
        return engine_->failure();
    });
    thread_->resume();
    ::setpriority(PRIO_PROCESS, static_cast<id_t>(::syscall(SYS_gettid)),
                  kNiceness); // not inherited by the other threads
}

bool LiveRun::pause() {
    hand_->setForces(false);
    thread_->pause();
    if (thread_->ended()) {
        return false;
    }
    forgetFrames();
    return true;
}

// Drops the memory of earlier frames, because a new run has a new clock. A lost device needs nothing: the
// next one has no memory.
void LiveRun::forgetFrames() {
    try {
        if (!session_.handover->lost()) {
            session_.cycles.frames().forget();
        }
    } catch (const DeviceFailed& e) {
        session_.handover->lose(e.what());
    }
}

void LiveRun::restart(const std::vector<Shape>& shapes, const StepRecord* tool) {
    if (session_.arm && tool != nullptr) {
        session_.arm->start = tool->arm.posture.q;
    }
    haptics_ = softStartOptions(session_);
    const Pose raw = steering_->pose(); // a copy, because makeEngine() replaces the steering
    makeEngine(shapes, raw, tool != nullptr ? &tool->tool : nullptr);
    thread_->resume();
}

std::optional<ImVec2> LiveRun::steer(Console& console, const ViewPort& large, double toolDepth) {
    return steering_->step(console, large, toolDepth);
}

void LiveRun::apply(Console& console) {
    if (hand_->takeSilence()) {
        console.switches.forcesOff();
        console.notify("the window stood still for over 2 s: forces are off");
    }
    hand_->setForces(console.switches.forces);
    feed_.freeze(console.switches.frozen);
    pilot_->ask({steering_->pose(), 0});
    hand_->press(buttonsOf(console));
}

// Buttons that keys hold down, added to the device's own.
uint32_t LiveRun::buttonsOf(const Console& console) const {
    const Console::Switches& switches = console.switches;
    const auto& arm = session_.scene.arm;
    const uint32_t grasp = arm ? arm->grasp.button : 0;
    return (switches.guidance ? kGuidanceButton : 0) | (switches.clutch ? session_.scene.hand.clutchBit : 0) |
           (switches.grasp ? grasp : 0);
}

void LiveRun::warnOfStart(const Scene& scene) const {
    fathom::warnOfStart(scene, session_.tool, session_.arm.get(), start_);
}

void LiveRun::setShapes(const std::vector<Shape>& shapes) {
    engine_->setShapes(shapes);
    observers_.setShapes(shapes);
}

} // namespace fathom::operate
