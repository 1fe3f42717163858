// SPDX-License-Identifier: Apache-2.0
#include "apps/operate/run_display.h"

#include "apps/operate/caption.h"
#include "apps/operate/closing.h"
#include "apps/operate/open_card.h"
#include "apps/output/output_folder.h"
#include "apps/output/try_output.h"
#include "engine/types/clock.h"
#include "engine/types/error.h"
#include "engine/types/input_files.h"

#include <algorithm>
#include <utility>

namespace fathom::operate {

namespace {

Console consoleFor(const Scene& scene, double textScale) {
    Console console;
    console.settings.take(scene, textScale);
    return console;
}

// Notes the hand path, which is read later, so that the state cannot replace it.
const std::string& stateFile(const OperateOptions& options, const Scene& scene) {
    if (!scene.hand.builtIn) {
        noteInput(scene.hand.path);
    }
    return options.state;
}

} // namespace

RunDisplay::RunDisplay(const OperateOptions& options, Window& window, Session& session, SnapshotSink& sink)
    : console(consoleFor(session.scene, options.textScale))
    , canvas(window, *session.instance, console.settings.textScale, options.shots)
    , view(sink)
    , options_(options)
    , window_(window)
    , session_(session)
    , camera_{session.camera->description(), session.camera->delivered(), session.camera->live(), false}
    , controlThread_(session.camera->controls())
    , pace_(session.cycles.device().facts().kind == DeviceKind::Cpu)
    , log_(stateFile(options, session.scene), options.appendsState) {
    if (endsWithShot()) {
        makeOutputFolder(options.shots);
        tryOutput("operate", "--folder", std::filesystem::path(options.shots) / kOffscreenShot);
    }
    canvas.open(session.cycles.device());
    screen.setCoarse(session.cycles.device().facts().kind == DeviceKind::Cpu);
}

void RunDisplay::begin() {
    started_ = lastFrame_ = monotonicSeconds();
    if (!options_.notice.empty()) {
        console.notify(options_.notice);
    }
}

double RunDisplay::beginFrame() {
    window_.setFullScreen(console.settings.fullScreen);
    const double period = pace_.period();
    window_.beginFrame(std::clamp(period - (monotonicSeconds() - lastFrame_), 0.0, period));
    pace_.note(threadCpuTime());
    const double now = monotonicSeconds(), dt = now - lastFrame_;
    windowHz_ += 0.05 * (1.0 / std::max(1e-3, dt) - windowHz_);
    lastFrame_ = now;
    console.status.monitorScale = window_.monitorScale();
    console.status.drawnScale =
        scaleThatFits(ImGui::GetIO().DisplaySize, console.settings.textScale * console.status.monitorScale,
                      console.settings.pilotLayout);
    return dt;
}

bool RunDisplay::beginLastShot() {
    if (!endsWithShot()) {
        return false;
    }
    console.requests.screenshot = true;
    window_.beginFrame(0.0);
    return true;
}

void RunDisplay::checkLastShot() const {
    if (endsWithShot() && !canvas.shotFault().empty()) {
        throw Error("operate: no screenshot: " + canvas.shotFault());
    }
}

void RunDisplay::followClosing(FixtureEditor& editor, bool forcesGone) {
    stepOpenCard(console, options_.shots, options_.fromLiveRun);
    const bool closed = window_.takeClose();
    if (closed) {
        console.openCard.next.clear(); // the end, whatever was chosen
    }
    stepClosing(console, editor,
                {std::exchange(console.openCard.leaves, false) || closed, forcesGone, elapsed()});
}

double RunDisplay::elapsed() const {
    return monotonicSeconds() - started_;
}

bool RunDisplay::wantsToEnd() const {
    return console.closing.quit || (options_.seconds > 0.0 && elapsed() >= options_.seconds);
}

HudInput RunDisplay::hud(const HapticOptions& haptics) {
    camera_.stampsExposure = session_.camera->stampsExposure();
    return {.run = view,
            .scene = session_.scene,
            .haptics = haptics,
            .passNames = session_.passNames,
            .fonts = canvas.fonts(),
            .title = session_.title(),
            .unknownShare = screen.unknownShare(),
            .windowHz = windowHz_,
            .camera = &camera_,
            .controlThread = &controlThread_};
}

void RunDisplay::draw(FixtureEditor& editor, const ScreenInput& input) {
    screen.noteDrawn(canvas.counts().drawn);
    screen.draw(console, editor, alarms, input);
    const bool captioned = !window_.offscreen() || !options_.job.empty();
    console.status.caption =
        captioned
            ? captionOf(
                  {{console, view, input.hud.haptics}, screen.cues(), editor.scene().pilot, options_.job})
            : std::vector<std::string>();
    controlThread_.show(console.panels.shownTab == Tab::Camera &&
                        (!console.settings.pilotLayout || console.panels.open));
    const auto& room = console.places["traces room"];
    if (room[3] <= 0.0f) {
        return; // not in the pilot's layout
    }
    traces_.draw(console, input.hud, {room[0], room[1]}, {room[2], room[3]});
}

void RunDisplay::exportTraces() {
    if (!std::exchange(console.requests.exportTraces, false)) {
        return;
    }
    const auto file = std::filesystem::path(options_.shots) / "traces.csv";
    try {
        traces_.exportCsv(view, file);
        console.notify("traces written to " + file.string());
    } catch (const Error& e) {
        console.notify(e.what());
    }
}

void RunDisplay::writeState(const FixtureEditor& editor, const HapticOptions& haptics,
                            const ShownArm* measured, const HandDeviceFacts& device, bool now) {
    log_.write({console, view, session_, window_, canvas, screen, alarms, editor, haptics, measured, device,
                pace_.cost(), &camera_, &controlThread_},
               now);
}

} // namespace fathom::operate
