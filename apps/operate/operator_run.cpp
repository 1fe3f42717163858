// SPDX-License-Identifier: Apache-2.0
#include "apps/operate/operator_run.h"

#include "apps/operate/arming.h"
#include "apps/operate/open_card.h"
#include "apps/operate/view_click.h"
#include "apps/replay/percentiles.h"
#include "engine/types/error.h"

#include <algorithm>
#include <cstdio>
#include <utility>

namespace fathom::operate {

namespace {

std::string title(const OperateOptions& options) {
    return "Fathom, " + options.scene.stem().string();
}

} // namespace

LiveSinks::LiveSinks(const OperateOptions& options, double period, const ArmSetup* arm)
    : observers(options.observers, arm)
    , last(recorder,
           options.offscreen.empty() ? LastSeconds::defaultMemory() : 0) // no key can store it there
    , published(last, observers)
    , faults(options.shots, period, published)
    , snapshots(faults) {}

OperatorRun::OperatorRun(const OperateOptions& options, const GlobalOptions& global)
    : options_(options)
    , placement_(ThreadPlacement::ofThisProcess())
    , window_(options.offscreen, title(options))
    , confined_(placement_.rest) // before the device opens: inherited by a software device's workers
    , session_(options, global,
               {window_.offscreen() ? gpu::Drawing::Offscreen : gpu::Drawing::Surface, window_.extensions()},
               signals_.requested())
    , sinks_(options, makeHapticOptions(session_.scene, session_.tool).period, session_.arm.get())
    , display_(options_, window_, session_, sinks_.snapshots)
    , editor_(session_.scene,
              [this](const Scene& scene, const std::vector<Shape>& shapes) { changeScene(scene, shapes); })
    , recording_(options.shots, sinks_.recorder, sinks_.last, session_)
    , tones_(window_.offscreen())
    , live_(options_, session_, signals_, placement_, sinks_.snapshots, sinks_.observers) {
    keepScene(0);
    live_.start(editor_.shapes());
    live_.warnOfStart(editor_.scene());
    display_.console.switches.forces = forces_.wereOn = options_.armed;
    window_.onForcesOff = [this] {
        live_.forcesOff(); // at once, before the rest of this frame
        forces_.offRequested = true;
    };
}

void OperatorRun::changeScene(const Scene& scene, const std::vector<Shape>& shapes) {
    const uint64_t number = live_.feed().setScene(scene);
    if (sinks_.recorder.recording()) {
        sinks_.recorder.edit(number, recordedScene(editor_));
    }
    keepScene(number);
    live_.setShapes(shapes);
}

void OperatorRun::keepScene(uint64_t number) {
    sinks_.last.edit({number, editor_.text(), recordedScene(editor_)});
}

bool OperatorRun::wantsToEnd() const {
    const bool reached = options_.runTime > 0.0 && display_.view.step().record.t >= options_.runTime;
    return reached || display_.wantsToEnd() || live_.ended() || signals_.requested().load();
}

std::string OperatorRun::next() const {
    return opensNext(display_.console, signals_.requested().load());
}

void OperatorRun::run() {
    display_.begin();
    while (!wantsToEnd()) {
        display_.beginFrame();
        frame();
    }
    if (display_.beginLastShot()) {
        frame();
    }
    writeState(true);
    live_.end();
    sinks_.recorder.stop();
    sinks_.recorder.finish();
    recording_.finish();
    display_.view.refresh();
    report();
    if (live_.failure()) {
        std::rethrow_exception(live_.failure());
    }
    display_.checkLastShot();
}

void OperatorRun::writeState(bool now) {
    display_.writeState(editor_, live_.haptics(), &measured_, live_.device(), now);
}

void OperatorRun::frame() {
    const bool fresh = display_.view.refresh();
    const StepRecord& record = display_.view.step().record;
    HudInput hud = display_.hud(live_.haptics());
    hud.driven = options_.path || session_.liveHand != nullptr;
    hud.arm = &measured_;
    hud.handGone = !live_.handPresent();
    hud.device = live_.device();
    hud.armHolds = armHolds(session_.arm.get(), record);
    const auto arm = armSpheres(session_.arm.get(), record.arm.posture);
    measured_ = measuredArm(session_.arm.get(), display_.view, arm);
    display_.draw(editor_, {display_.view, session_.tool, hud, fresh, arm, measured_});
    handleInput();
    display_.alarms.step(display_.console, display_.view, live_.haptics(), editor_.scene(),
                         {session_.handover->notInUse(), !live_.handPresent(), sinks_.recorder.failure()});
    tones_.step(display_.console, display_.view, display_.alarms);
    show();
    writeState(false);
}

void OperatorRun::handleInput() {
    Console& console = display_.console;
    const ViewPort& large = display_.screen.large();
    const double depth = large.view.cameraTbase.apply(display_.view.step().record.device.position).z;
    if (const auto at = live_.steer(console, large, depth)) {
        clickInView(console, editor_, display_.screen, display_.view.scene(), *at);
    }
    if (std::exchange(forces_.offRequested, false)) { // overrides all other keys of this frame
        console.switches.forcesOff();
    }
    display_.followClosing(editor_, forcesGone());
    offWhenMinimised();
    obeyObservers();
    checkArming();
    live_.mapButtons(console);
    live_.apply(console);
    mark();
    recording_.follow(console, editor_);
    switchPilot();
    display_.exportTraces();
    forces_.wereOn = console.switches.forces; // after everything that may switch them off
}

void OperatorRun::mark() {
    Console& console = display_.console;
    if (std::exchange(console.requests.exportImages, false)) {
        console.notify("only a recording is exported: open one");
    }
    if (std::exchange(console.requests.mark, false)) {
        sinks_.recorder.mark();
        sinks_.last.mark();
        console.notify("mark " + std::to_string(++console.status.marks) +
                       (console.switches.recording ? " is in the recording"
                                                   : " is kept with the last seconds: L stores them"));
    }
}

bool OperatorRun::forcesGone() const {
    const StepRecord& record = display_.view.step().record;
    return !display_.console.switches.forces &&
           (!display_.view.anyTick() || record.state == StepState::Off ||
            (record.wrench.force == dvec3(0.0) && record.wrench.torque == dvec3(0.0)));
}

// Forces without a view of the scene would surprise the pilot.
void OperatorRun::offWhenMinimised() {
    Console& console = display_.console;
    if (console.switches.forces && window_.minimised()) {
        console.switches.forcesOff();
        console.notify("minimised: forces are off");
    }
}

void OperatorRun::obeyObservers() {
    Console& console = display_.console;
    Console::Switches& switches = console.switches;
    const RemoteRequests requests = sinks_.observers.takeRequests();
    switches.guidance = requests.guidance.value_or(switches.guidance);
    switches.frozen = requests.frozen.value_or(switches.frozen);
    if (requests.forcesOff) {
        switches.forcesOff();
        console.notify("forces off: another program asked for it");
    } else if (requests.guidance || requests.frozen) {
        console.notify("another program switched guidance or freezing");
    }
}

// Forces come on only if no check fails.
void OperatorRun::checkArming() {
    Console& console = display_.console;
    Console::Switches& switches = console.switches;
    if (switches.forces && !forces_.wereOn) {
        console.messages.refusal = whyNotArmed({display_.view, editor_.scene(), live_.haptics(),
                                                session_.handover->notInUse(), !live_.handPresent()});
        switches.forces = console.messages.refusal.empty();
    }
}

// Springs, limits and scale are constant during a run. So this turns forces off, keeps the tool where it is,
// and starts a new run there.
void OperatorRun::switchPilot() {
    Console& console = display_.console;
    const std::string name = std::exchange(console.requests.pilot, "");
    const bool gpuGone = session_.handover->notInUse(); // the new run starts with the previous regions then
    if (!name.empty() && !gpuGone && cameraSilent(display_.view.step().record)) {
        return console.notify("no camera frames: choose the pilot when they are back");
    }
    if (name.empty() || !session_.scene.choosePilot(name)) {
        return;
    }
    console.switches.forcesOff();
    console.switches.recording = console.switches.frozen = false;
    live_.feed().freeze(false);
    recording_.follow(console, editor_);
    if (!live_.pause()) {
        return; // the run failed: the window ends
    }
    display_.view.refresh();
    const StepRecord last = display_.view.step().record;
    const bool stays = display_.view.anyTick() && !options_.path && isFinite(last.tool);
    display_.view.rewind();
    editor_.keepSettings(console.settings.saved(), name);
    live_.restart(editor_.shapes(), stays ? &last : nullptr);
    live_.warnOfStart(editor_.scene());
    console.notify(name + " is the pilot now: switch forces on");
}

// Window and frame thread each detect a lost device; only the window knows when it no longer draws on it.
void OperatorRun::show() {
    DeviceHandover& device = *session_.handover;
    try {
        display_.canvas.finishFrame(display_.console, display_.screen.layers(),
                                    [this] { return live_.feed().busy(); });
        if (display_.canvas.isOpen()) {
            device.accept(); // once it has drawn
        } else if (device.offered()) {
            reopen();
        }
    } catch (const DeviceFailed& e) {
        device.lose(e.what());
    }
    if (device.wanted()) {
        display_.canvas.drop();
        device.release();
    }
    const bool gone = device.notInUse();
    if (std::exchange(showsGone_, gone) != gone) { // as text, which needs no GPU
        window_.setTitle(title(options_) + (gone ? ": GPU is gone, forces fade" : ""));
    }
}

// Only between frames, because an open ImGui frame refers to textures of the old device.
void OperatorRun::reopen() {
    try {
        display_.canvas.open(session_.cycles.device());
        display_.screen.redraw();
    } catch (const Error& e) { // a driver that restarts may report any error
        session_.handover->lose(e.what());
    }
}

void OperatorRun::report() const {
    const std::vector<float>& micros = display_.view.stepMicros();
    const Percentiles us = percentilesOf(micros);
    const double time = std::max(1e-3, display_.elapsed());
    std::printf(
        "window       %.1f frames per second, %llu skipped for passes on the shared queue, %.1f ms of CPU "
        "time each\n",
        static_cast<double>(display_.canvas.counts().drawn) / time,
        static_cast<unsigned long long>(display_.canvas.counts().yielded), 1e3 * display_.frameCost());
    if (session_.cycles.renewals() > 0) {
        std::printf("device       lost and reopened %u times\n", session_.cycles.renewals());
    }
    std::printf("step         p50 %.2f p99 %.2f max %.2f us, %zu ticks, %llu ended over one period late, "
                "%llu periods without one\n",
                us.p50.value_or(0.0), us.p99.value_or(0.0), us.max.value_or(0.0), micros.size(),
                static_cast<unsigned long long>(display_.view.lateTicks()),
                static_cast<unsigned long long>(live_.engine().periodsMissed()));
}

} // namespace fathom::operate
