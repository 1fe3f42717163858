// SPDX-License-Identifier: Apache-2.0
#include "apps/operate/playback_run.h"

#include "apps/operate/shown_state.h"
#include "apps/operate/view_click.h"
#include "devices/recorded/hand_csv.h"
#include "engine/haptics/hand_map.h"
#include "engine/types/error.h"
#include "engine/types/log.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <limits>

namespace fathom::operate {

namespace {

constexpr double kDrawPeriod = 1.0 / 60.0;               // [s] shortest period of the window
constexpr double kFirstRetry = 0.1, kLongestRetry = 2.0; // [s]

double playedSeconds() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

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
        Moment moment;
        moment.t = w.t;
        moment.device = map.map(w.deviceThandle, (w.buttons & scene.hand.clutchBit) != 0);
        moment.tool.position = dvec3(kNone);
        moment.marginPassive = moment.marginUncoupled = kNone;
        log.moments.push_back(moment);
    }
    return log;
}

// The recorded ticks. If wrench.csv has no poses, the hand comes from its own file.
TickLog turnsOf(const std::filesystem::path& folder, const std::optional<HandPath>& hand,
                const Scene& scene) {
    TickLog log = readTickLog(folder);
    if (!hand || log.poses) {
        return log;
    }
    TickLog mapped = mappedHand(*hand, scene);
    if (log.moments.empty()) {
        return mapped;
    }
    for (Moment& moment : log.moments) {
        const auto at = std::upper_bound(mapped.moments.begin(), mapped.moments.end(), moment.t,
                                         [](double t, const Moment& m) { return t < m.t; });
        moment.device = (at == mapped.moments.begin() ? at : at - 1)->device;
        moment.tool.position = dvec3(std::numeric_limits<double>::quiet_NaN());
    }
    return log;
}

double durationOf(const PastScene& past, const TickLog& log) {
    const double images = past.images() * PastScene::kPeriod;
    return log.moments.empty() ? images : std::max(images, log.moments.back().t);
}

} // namespace

PlaybackRun::PlaybackRun(const OperateOptions& options, const GlobalOptions& global)
    : options_(options)
    , window_(options.offscreen, "Fathom, recording " + options.recording)
    , session_(options, global,
               {window_.offscreen() ? gpu::Drawing::Offscreen : gpu::Drawing::Surface, window_.extensions()},
               signals_.asked())
    , haptics_(makeHapticOptions(session_.scene, session_.tool))
    , hand_(handOf(options.recording))
    , log_(turnsOf(options.recording, hand_, session_.scene))
    , past_(session_)
    , sink_(nothing_)
    , view_(sink_)
    , editor_(session_.scene,
              [this](const Scene& scene, const std::vector<Shape>&) {
                  past_.setScene(scene);
                  shown_ = -1.0;
              })
    , steering_(Pose{}, session_.scene.hand)
    , panel_(log_, durationOf(past_, log_))
    , state_(options.state) {
    console_.takeSettings(session_.scene, options.textScale);
    canvas_ = std::make_unique<Canvas>(window_, *session_.instance, console_.textScale, options.shots);
    canvas_->open(session_.cycles.device());
    console_.timeLine.on = true;
    console_.timeLine.images = past_.images();
    console_.timeLine.duration = durationOf(past_, log_);
    if (log_.moments.empty()) {
        console_.notify("no hand.csv or wrench.csv there: frames only");
    }
}

void PlaybackRun::run() {
    double last = started_ = playedSeconds();
    while (!wantsToEnd()) {
        window_.beginFrame(std::clamp(kDrawPeriod - (playedSeconds() - last), 0.0, kDrawPeriod));
        const double now = playedSeconds(), dt = now - last;
        windowHz_ += 0.05 * (1.0 / std::max(1e-3, dt) - windowHz_);
        last = now;
        frame(dt);
    }
    state_.write(console_, view_, extras(), true);
}

bool PlaybackRun::wantsToEnd() const {
    return window_.closed() || console_.quit || signals_.asked().load() ||
           (options_.seconds > 0.0 && playedSeconds() - started_ >= options_.seconds);
}

void PlaybackRun::frame(double dt) {
    if (canvas_->isOpen()) {
        try {
            draw(dt);
        } catch (const DeviceFailed& e) {
            loseDevice(e.what());
        }
    } else {
        ImGui::EndFrame();
        lookForDevice();
    }
    state_.write(console_, view_, extras());
}

void PlaybackRun::loseDevice(const std::string& why) {
    log::warn("GPU is gone ({}): it is looked for", why);
    ImGui::EndFrame(); // does nothing when the frame has already ended
    canvas_->drop();
    retry_ = kFirstRetry;
    retryAt_ = playedSeconds() + retry_;
}

void PlaybackRun::lookForDevice() {
    if (playedSeconds() < retryAt_) {
        return;
    }
    try {
        session_.cycles.renew();
        canvas_->open(session_.cycles.device());
    } catch (const Error& e) { // a driver that restarts may report any error
        log::debug("GPU: {}", e.what());
        retry_ = std::min(2.0 * retry_, kLongestRetry);
        retryAt_ = playedSeconds() + retry_;
        return;
    }
    log::warn("GPU is back");
    console_.notify("The GPU was gone and is back");
    past_.retake();
    screen_.redraw();
}

void PlaybackRun::draw(double dt) {
    followTime(dt);
    const bool fresh = view_.refresh();
    const HudInput hud{view_,
                       session_.scene,
                       haptics_,
                       session_.passNames,
                       canvas_->letters(),
                       options_.recording,
                       screen_.unknownShare(),
                       windowHz_,
                       true};
    alarms_ = Alarms(); // alarms of this moment only, none latched
    alarms_.step(console_, view_, haptics_, editor_.scene());
    const bool known = log_.poses && view_.anyTurn();
    const auto arm = armSpheres(known ? session_.arm.get() : nullptr, view_.step().record.arm.posture);
    screen_.draw(console_, editor_, alarms_, {view_, session_.tool, hud, fresh, arm, MeasuredArm()});
    const auto& room = console_.places["traces room"];
    traces_.draw(console_, hud, {room[0], room[1]}, {room[2], room[3]});
    const auto& strip = console_.places["time line room"];
    panel_.draw(console_, canvas_->letters(), {strip[0], strip[1]}, {strip[2], strip[3]});
    listen();
    canvas_->finishFrame(console_, screen_.layers(), [] { return false; });
}

void PlaybackRun::listen() {
    if (const auto at = steering_.step(console_, screen_.large(), 0.0)) {
        clickInView(console_, editor_, screen_, view_.scene(), *at);
    }
    panel_.listen(console_);
    console_.recording = console_.frozen = false; // not available in playback
    if (console_.exportCsv) {
        console_.exportCsv = false;
        try {
            traces_.exportCsv(view_, std::filesystem::path(options_.shots) / "traces.csv");
            console_.notify("traces written");
        } catch (const Error& e) {
            console_.notify(e.what());
        }
    }
}

void PlaybackRun::followTime(double dt) {
    TimeLine& line = console_.timeLine;
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
    line.image = past_.shown();
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
    view_.rewind();
    const double t = console_.timeLine.t;
    const auto& moments = log_.moments;
    const auto after = [&](double when) {
        return static_cast<size_t>(
            std::upper_bound(moments.begin(), moments.end(), when,
                             [](double value, const Moment& m) { return value < m.t; }) -
            moments.begin());
    };
    const size_t end = after(t + kSame);
    TickRow row;
    for (size_t i = after(t - RunView::kSpan); i < end; ++i) {
        row.record = log_.recordAt(i);
        view_.take(row);
    }
    const uint32_t buttons = buttonsAt(t);
    console_.forces = (buttons & kDeadManOpen) == 0;
    console_.guidance = (buttons & kGuidanceButton) != 0;
}

StateExtras PlaybackRun::extras() const {
    return extrasOf({console_, view_, session_, window_, *canvas_, screen_, alarms_, editor_, haptics_});
}

} // namespace fathom::operate
