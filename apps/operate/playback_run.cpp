// SPDX-License-Identifier: Apache-2.0
#include "apps/operate/playback_run.h"

#include "apps/operate/keys.h"
#include "apps/operate/open_card.h"
#include "apps/operate/view_click.h"
#include "devices/recorded/hand_csv.h"
#include "engine/haptics/hand_map.h"
#include "engine/types/error.h"
#include "engine/types/log.h"
#include "engine/types/printed.h"

#include <GLFW/glfw3.h>
#include <algorithm>
#include <limits>
#include <utility>

namespace fathom::operate {

namespace {

std::optional<HandPath> handOf(const std::filesystem::path& folder) {
    const auto file = folder / "hand.csv";
    return std::filesystem::exists(file) ? std::optional(HandPath(readHandCsv(file))) : std::nullopt;
}

// A log with the device's pose only, computed from the raw hand by the hand map and clutch; no tool, no
// wrench.
TickLog mappedHand(const HandPath& hand, const Scene& scene) {
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    TickLog log;
    HandMap map(scene.hand.baseRdevice, scene.hand.scale);
    for (const HandWaypoint& w : hand.waypoints()) {
        if (log.ticks.size() >= kMaxLoggedTicks) {
            log.cut = true;
            break;
        }
        RecordedTick recorded;
        recorded.t = w.t;
        recorded.device = map.map(w.deviceThandle, (w.buttons & scene.hand.clutchBit) != 0);
        recorded.tool.position = dvec3(kNone);
        recorded.marginPassive = recorded.marginUncoupled = kNone;
        log.ticks.push_back(recorded);
    }
    return log;
}

// The recorded ticks. If wrench.csv has no poses, the hand comes from its own file.
TickLog ticksOf(const std::filesystem::path& folder, const std::optional<HandPath>& hand,
                const Scene& scene) {
    TickLog log = readTickLog(folder);
    if (!hand || log.poses) {
        return log;
    }
    TickLog mapped = mappedHand(*hand, scene);
    if (log.ticks.empty()) {
        return mapped;
    }
    for (RecordedTick& recorded : log.ticks) {
        const auto at = std::ranges::upper_bound(mapped.ticks, recorded.t, {}, &RecordedTick::t);
        recorded.device = (at == mapped.ticks.begin() ? at : at - 1)->device;
        recorded.tool.position = dvec3(std::numeric_limits<double>::quiet_NaN());
    }
    return log;
}

double durationOf(const PastScene& past, const TickLog& log) {
    const double framesEnd = past.frames() * PastScene::kPeriod;
    return log.ticks.empty() ? framesEnd : std::max(framesEnd, log.ticks.back().t);
}

} // namespace

PlaybackRun::PlaybackRun(const OperateOptions& options, const GlobalOptions& global)
    : options_(options)
    , window_(options.offscreen, "Fathom, recording " + options.recording)
    , session_(options, global,
               {window_.offscreen() ? gpu::Drawing::Offscreen : gpu::Drawing::Surface, window_.extensions()},
               signals_.requested())
    , haptics_(makeHapticOptions(session_.scene, session_.tool))
    , hand_(handOf(options.recording))
    , log_(ticksOf(options.recording, hand_, session_.scene))
    , past_(session_)
    , sink_(unusedRecorder_)
    , display_(options_, window_, session_, sink_)
    , editor_(session_.scene,
              [this](const Scene& scene, const std::vector<Shape>&) {
                  past_.setScene(scene);
                  shown_ = -1.0;
              })
    , steering_(Pose{}, session_.scene.hand)
    , panel_(log_, durationOf(past_, log_))
    , export_(options.shots) {
    TimeLine& line = display_.console.timeLine;
    line.on = true;
    line.frames = past_.frames();
    line.duration = durationOf(past_, log_);
    line.marks = readMarks(options.recording);
    if (log_.ticks.empty()) {
        display_.console.notify("no hand.csv or wrench.csv there: frames only");
    }
    if (log_.cut) {
        display_.console.notify("the recording has more than " + std::to_string(kMaxLoggedTicks) +
                                " ticks: later ones are not shown");
    }
}

void PlaybackRun::run() {
    display_.begin();
    while (!display_.wantsToEnd() && !signals_.requested().load()) {
        frame(display_.beginFrame());
    }
    if (display_.beginLastShot()) {
        frame(0.0);
    }
    display_.writeState(editor_, haptics_, nullptr, {}, true);
    display_.checkLastShot();
}

std::string PlaybackRun::next() const {
    return opensNext(display_.console, signals_.requested().load());
}

void PlaybackRun::frame(double dt) {
    if (display_.canvas.isOpen()) {
        try {
            draw(dt);
        } catch (const DeviceFailed& e) {
            loseDevice(e.what());
        }
    } else {
        display_.console.closing.quit = window_.takeClose(); // without a device there is no question
        display_.console.openCard.next.clear();
        ImGui::EndFrame();
        lookForDevice();
    }
    display_.writeState(editor_, haptics_, nullptr, {}, false);
}

void PlaybackRun::loseDevice(const std::string& why) {
    log::warn("GPU is gone ({}): retrying", why);
    ImGui::EndFrame(); // does nothing when the frame has already ended
    display_.canvas.drop();
    retry_.reset();
    retryAt_ = display_.elapsed() + retry_.next();
}

void PlaybackRun::lookForDevice() {
    if (display_.elapsed() < retryAt_) {
        return;
    }
    try {
        session_.cycles.renew();
        display_.canvas.open(session_.cycles.device());
    } catch (const Error& e) { // a driver that restarts may report any error
        log::debug("GPU: {}", e.what());
        retryAt_ = display_.elapsed() + retry_.next();
        return;
    }
    log::warn("GPU is back");
    display_.console.notify("The GPU was gone and is back");
    past_.retake();
    display_.screen.redraw();
}

void PlaybackRun::draw(double dt) {
    export_.step(display_.console, PastScene::kPeriod);
    followTime(dt);
    const bool fresh = display_.view.refresh();
    HudInput hud = display_.hud(haptics_);
    hud.title = options_.recording;
    hud.driven = true;
    display_.alarms = Alarms(0.0); // alarms of this moment only, none latched
    display_.alarms.step(display_.console, display_.view, haptics_, editor_.scene());
    const bool known = log_.poses && display_.view.anyTick();
    const auto arm =
        armSpheres(known ? session_.arm.get() : nullptr, display_.view.step().record.arm.posture);
    display_.draw(editor_, {display_.view, session_.tool, hud, fresh, arm, ShownArm()});
    const auto& strip = display_.console.places["time line room"];
    panel_.draw(display_.console, display_.canvas.fonts(), {strip[0], strip[1]}, {strip[2], strip[3]});
    handleInput();
    display_.canvas.finishFrame(display_.console, display_.screen.layers(), [] { return false; });
    if (export_.running() && !window_.minimised()) { // a minimised window draws nothing
        exportImage();
    }
}

void PlaybackRun::exportImage() {
    const std::unique_ptr<Image> image = display_.canvas.frameImage(display_.console);
    export_.add(display_.console, image.get());
    window_.setTitle(printed("Fathom, exports image %u of %u, Esc stops", display_.console.timeLine.frame + 1,
                             display_.console.timeLine.frames));
    if (!export_.running() || display_.console.timeLine.frame + 1 >= display_.console.timeLine.frames) {
        window_.setTitle("Fathom, recording " + options_.recording);
    }
}

void PlaybackRun::handleInput() {
    Console& console = display_.console;
    console.requests.stopExport = keyPressed(GLFW_KEY_ESCAPE);
    if (const auto at = steering_.step(console, display_.screen.large(), 0.0)) {
        clickInView(console, editor_, display_.screen, display_.view.scene(), *at);
    }
    panel_.handleKeys(console);
    mark();
    display_.followClosing(editor_, true);
    console.switches.recording = console.switches.frozen = false; // not available in playback
    display_.exportTraces();
}

void PlaybackRun::mark() {
    Console& console = display_.console;
    if (!std::exchange(console.requests.mark, false)) {
        return;
    }
    try {
        addMark(options_.recording, console.timeLine.marks, console.timeLine.t);
        console.notify("mark " + std::to_string(console.timeLine.marks.size()) + " added to the recording");
    } catch (const Error& e) {
        console.notify(e.what());
    }
}

void PlaybackRun::followTime(double dt) {
    TimeLine& line = display_.console.timeLine;
    if (line.playing) {
        line.t += dt * line.speed;
        line.playing = line.t < line.duration;
    }
    line.t = std::clamp(line.t, 0.0, line.duration);
    const auto image = static_cast<uint32_t>(line.t / PastScene::kPeriod + 1e-6);
    past_.show(image, !line.dragged, sink_);
    if (const Scene* scene = past_.newScene()) {
        editor_.showFixtures(*scene);
    }
    line.frame = past_.shown();
    line.wholeMemory = past_.whole();
    if (line.t != shown_) {
        shown_ = line.t;
        showMoment();
    }
}

uint32_t PlaybackRun::buttonsAt(double t) const {
    return hand_ ? hand_->at(t).buttons : kDeadManOpen;
}

// Loads the ten seconds before this moment, so that traces and blocks show what they showed then.
void PlaybackRun::showMoment() {
    constexpr double kSame = 1e-9; // [s]
    display_.view.rewind();
    const double t = display_.console.timeLine.t;
    const auto& ticks = log_.ticks;
    const auto after = [&](double when) {
        return static_cast<size_t>(std::ranges::upper_bound(ticks, when, {}, &RecordedTick::t) -
                                   ticks.begin());
    };
    const size_t end = after(t + kSame);
    for (size_t i = after(t - RunView::kSpan); i < end; ++i) {
        display_.view.take(log_.rowAt(i, hand_ ? &*hand_ : nullptr));
    }
    const uint32_t buttons = buttonsAt(t);
    display_.console.switches.forces = (buttons & kDeadManOpen) == 0;
    display_.console.switches.guidance = (buttons & kGuidanceButton) != 0;
}

} // namespace fathom::operate
