// SPDX-License-Identifier: Apache-2.0
// Creates the threads of the run and the objects that they use: at the start, and again for another pilot.
#include "apps/binding/raw_path.h"
#include "apps/operate/operator_run.h"
#include "engine/types/error.h"

#include <limits>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>
#include <utility>

namespace fathom::operate {

namespace {

constexpr double kSoftStart = 1.5; // [s]
constexpr int kNiceness = 5;       // lowers the window thread's priority below camera and contacts

} // namespace

HapticOptions OperatorRun::softly(const Scene& scene, const Tool& tool) {
    HapticOptions options = makeHapticOptions(scene, tool);
    options.armTime = kSoftStart;
    return options;
}

HapticDevice& OperatorRun::device() {
    if (session_.liveHand) {
        return *session_.liveHand;
    }
    return options_.path ? static_cast<HapticDevice&>(*path_) : *pilot_;
}

// Creates the hand. start: raw pose of a hand that the window moves. tool: where the tool stays; null = at
// the start of the path. A live hand may be at any pose, and may not be connected yet.
void OperatorRun::makeHand(const Pose& start, const Pose* tool) {
    const HandPath path = session_.path();
    const LiveHand* live = session_.liveHand.get();
    const Pose place = tool != nullptr ? *tool : startOf(path, session_.scene);
    Pose raw = tool != nullptr ? start : path.waypoints().front().deviceThandle;
    pilot_ = std::make_unique<PilotHand>(raw);
    path_ = std::make_unique<PathHand>(path);
    hand_ = std::make_unique<GatedHand>(device(), live);
    steering_ = std::make_unique<Steering>(raw, session_.scene.hand);
    raw = live != nullptr ? hand_->read(0.0).deviceThandle : raw;
    const std::vector<Shape> shapes = editor_ ? editor_->shapes() : shapesOf(session_.scene);
    const bool anywhere = live != nullptr || (session_.arm && !options_.path); // the hand may start elsewhere
    cycle_ =
        std::make_unique<HapticCycle>(session_.tool, shapes, haptics_, raw,
                                      tool != nullptr || anywhere ? &place : nullptr, session_.arm.get());
}

void OperatorRun::makeEngine(const Pose& start, const Pose* tool) {
    RealtimeOptions o;
    o.placement = placement_;
    o.hapticPeriod = haptics_.period;
    o.staleAfter = std::numeric_limits<double>::infinity(); // the window reports it
    if (session_.realArm) {
        if (engine_ == nullptr) {
            session_.awaitArm(signals_.asked());
        }
        o.arm = &session_.realArm->link();
    }
    if (observers_) { // their set belongs to the previous run
        observers_->forget();
        observers_->setShapes(editor_ ? editor_->shapes() : shapesOf(session_.scene));
    }
    engine_ = std::make_unique<RealtimeRun>(feed_, session_.contacts(), o);
    feed_.begin();
    session_.requireFrame(engine_->firstFrame());
    makeHand(start, tool);
}

void OperatorRun::startThreads() {
    makeEngine({}, nullptr);
    editor_ = std::make_unique<FixtureEditor>(session_.scene,
                                              [this](const Scene& scene, const std::vector<Shape>& shapes) {
                                                  const uint64_t number = feed_.setScene(scene);
                                                  if (recorder_.recording()) {
                                                      recorder_.edit(number, recordedScene(*editor_));
                                                  }
                                                  engine_->setShapes(shapes);
                                                  if (observers_) {
                                                      observers_->setShapes(shapes);
                                                  }
                                              });
    thread_ = std::make_unique<RunThread>([this](const std::atomic<bool>& stop) {
        engine_->run(*cycle_, *hand_, std::numeric_limits<double>::infinity(), sink_, stop);
        return engine_->failure();
    });
    thread_->resume();
    ::setpriority(PRIO_PROCESS, static_cast<id_t>(::syscall(SYS_gettid)),
                  kNiceness); // not inherited by the other threads
}

// Drops the memory of earlier frames, because a new run has a new clock. A lost device needs nothing: the
// next one has no memory.
void OperatorRun::forgetFrames() {
    try {
        if (!session_.handover->lost()) {
            session_.cycles.frames().forget();
        }
    } catch (const DeviceFailed& e) {
        session_.handover->lose(e.what());
    }
}

// Springs, limits and scale are constant during a run. So this turns forces off, keeps the tool where it is,
// and starts a new run there.
void OperatorRun::followPilot() {
    const std::string name = std::exchange(console_.pilotWanted, "");
    if (name.empty() || !session_.scene.choosePilot(name)) {
        return;
    }
    console_.forces = console_.guidance = console_.recording = console_.frozen = false;
    feed_.freeze(false);
    followRecorder();
    hand_->setForces(false);
    thread_->pause();
    if (thread_->ended()) {
        return; // the run failed: the window ends
    }
    forgetFrames();
    view_.refresh();
    const StepRecord last = view_.step().record;
    const Pose raw = steering_->pose();
    const bool stays = view_.anyTurn() && !options_.path && isFinite(last.tool);
    if (session_.arm && stays) {
        session_.arm->start = last.arm.posture.q;
    }
    view_.rewind();
    haptics_ = softly(session_.scene, session_.tool);
    editor_->keep(console_.settings(), name);
    makeEngine(raw, stays ? &last.tool : nullptr);
    thread_->resume();
    console_.notify(name + " flies now: arm the forces");
}

} // namespace fathom::operate
