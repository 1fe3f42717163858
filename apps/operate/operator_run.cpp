// SPDX-License-Identifier: Apache-2.0
#include "apps/operate/operator_run.h"

#include "apps/operate/shown_state.h"
#include "engine/types/error.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <utility>

namespace fathom::operate {

namespace {

constexpr double kFramePeriod = 1.0 / 60.0; // [s] shortest period of the window

double seconds() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

float percentile(std::vector<float> values, double share) {
    if (values.empty()) {
        return 0.0f;
    }
    const auto at =
        values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), at, values.end());
    return *at;
}

std::string title(const OperateOptions& options) {
    return "Fathom, " + options.scene.stem().string();
}

} // namespace

OperatorRun::OperatorRun(const OperateOptions& options, const GlobalOptions& global)
    : options_(options)
    , placement_(ThreadPlacement::ofThisProcess())
    , window_(options.offscreen, title(options))
    , confined_(placement_.rest) // before the device opens: inherited by a software device's workers
    , session_(options, global,
               {window_.offscreen() ? gpu::Drawing::Offscreen : gpu::Drawing::Surface, window_.extensions()},
               signals_.asked())
    , haptics_(softly(session_.scene, session_.tool))
    , feed_(session_)
    , observers_(options.viewEndpoint.empty() ? nullptr
                                              : std::make_unique<ViewPublisher>(options.viewEndpoint))
    , published_(recorder_, observers_.get())
    , faults_(options.shots, haptics_.period, published_)
    , sink_(faults_)
    , view_(sink_)
    , log_(options.state) {
    console_.takeSettings(session_.scene, options.textScale);
    canvas_ = std::make_unique<Canvas>(window_, *session_.instance, console_.textScale, options.shots);
    canvas_->open(session_.cycles.device());
    startThreads();
    console_.forces = options_.armed;
    window_.onForcesOff = [this] {
        hand_->setForces(false); // at once, before the rest of this frame
        forcesOff_ = true;
    };
}

bool OperatorRun::wantsToEnd() const {
    const bool turned = options_.ticks > 0.0 && view_.step().record.t >= options_.ticks;
    return turned || window_.closed() || console_.quit || thread_->ended() || signals_.asked().load() ||
           (options_.seconds > 0.0 && seconds() - started_ >= options_.seconds);
}

HudInput OperatorRun::hudInput() const {
    HudInput hud{view_,
                 session_.scene,
                 haptics_,
                 session_.passNames,
                 canvas_->letters(),
                 session_.title(),
                 screen_.unknownShare(),
                 windowHz_,
                 options_.path || session_.liveHand != nullptr,
                 &measured_,
                 !hand_->there(),
                 armHolds(session_.arm.get(), view_.step().record)};
    return hud;
}

void OperatorRun::run() {
    started_ = lastFrame_ = seconds();
    while (!wantsToEnd()) {
        const double spent = seconds() - lastFrame_;
        window_.beginFrame(std::clamp(kFramePeriod - spent, 0.0, kFramePeriod));
        const double now = seconds();
        windowHz_ += 0.05 * (1.0 / std::max(1e-3, now - lastFrame_) - windowHz_);
        lastFrame_ = now;
        frame();
    }
    if (window_.offscreen() && !options_.shots.empty()) { // no key can request one offscreen
        console_.screenshot = true;
        window_.beginFrame(0.0);
        frame();
    }
    log_.write(console_, view_, extras(), true);
    thread_->end();
    recorder_.stop();
    recorder_.finish();
    view_.refresh();
    report();
    if (thread_->failure()) {
        std::rethrow_exception(thread_->failure());
    }
}

void OperatorRun::frame() {
    const bool fresh = view_.refresh();
    const HudInput hud = hudInput();
    const auto arm = armSpheres(session_.arm.get(), view_.step().record.arm.posture);
    measured_ = measuredArm(session_.arm.get(), view_, arm);
    screen_.draw(console_, *editor_, alarms_, {view_, session_.tool, hud, fresh, arm, measured_});
    const auto& room = console_.places["traces room"];
    traces_.draw(console_, hud, {room[0], room[1]}, {room[2], room[3]});
    listen();
    alarms_.step(console_, view_, haptics_, editor_->scene(),
                 {session_.handover->gone(), !hand_->there(), recorder_.failure()});
    show();
    log_.write(console_, view_, extras());
}

// Window and frame thread each detect a lost device; only the window knows when it no longer draws on it.
void OperatorRun::show() {
    DeviceHandover& device = *session_.handover;
    try {
        canvas_->finishFrame(console_, screen_.layers(), [this] { return feed_.busy(); });
        if (canvas_->isOpen()) {
            device.accept(); // once it has drawn
        } else if (device.offered()) {
            reopen();
        }
    } catch (const DeviceFailed& e) {
        device.lose(e.what());
    }
    if (device.wanted()) {
        canvas_->drop();
        device.release();
    }
    const bool gone = device.gone();
    if (std::exchange(toldGone_, gone) != gone) { // as text, which needs no GPU
        window_.setTitle(title(options_) + (gone ? ": GPU is gone, forces fade" : ""));
    }
}

// Only between frames, because an open ImGui frame refers to textures of the old device.
void OperatorRun::reopen() {
    try {
        canvas_->open(session_.cycles.device());
        screen_.redraw();
    } catch (const Error& e) { // a driver that restarts may report any error
        session_.handover->lose(e.what());
    }
}

StateExtras OperatorRun::extras() const {
    StateExtras extras =
        extrasOf({console_, view_, session_, window_, *canvas_, screen_, alarms_, *editor_, haptics_});
    extras.arm = &measured_;
    extras.hand = session_.liveHand ? session_.liveHand->description() : "";
    extras.handThere = hand_->there();
    return extras;
}

void OperatorRun::report() const {
    const std::vector<float>& us = view_.stepMicros();
    const double time = std::max(1e-3, seconds() - started_);
    std::printf("window       %.1f frames a second, %llu left out for passes on the shared queue\n",
                static_cast<double>(canvas_->counts().drawn) / time,
                static_cast<unsigned long long>(canvas_->counts().yielded));
    if (session_.cycles.renewals() > 0) {
        std::printf("device       lost and made anew %u times\n", session_.cycles.renewals());
    }
    std::printf("turn         p50 %.2f p99 %.2f max %.2f us, %zu turns, %llu ended over one period late, "
                "%llu periods without one\n",
                static_cast<double>(percentile(us, 0.5)), static_cast<double>(percentile(us, 0.99)),
                static_cast<double>(percentile(us, 1.0)), us.size(),
                static_cast<unsigned long long>(view_.lateTurns()),
                static_cast<unsigned long long>(engine_->periodsMissed()));
}

} // namespace fathom::operate
