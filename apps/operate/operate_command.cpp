// SPDX-License-Identifier: Apache-2.0
#include "apps/operate/operate_command.h"

#include "apps/binding/open_hand.h"
#include "apps/binding/open_source.h"
#include "apps/number_option.h"
#include "apps/operate/operator_run.h"
#include "apps/operate/playback_run.h"
#include "engine/types/error.h"
#include "engine/types/input_files.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <utility>

namespace fathom {

namespace {

void checkJob(const std::vector<std::string>& lines) {
    constexpr size_t kMaxLines = 2, kLongest = 100;
    if (lines.size() > kMaxLines) {
        throw BadInput("operate", "--job", lines.back(), "at most two lines");
    }
    for (const std::string& line : lines) {
        const bool plain = std::ranges::all_of(
            line, [](char c) { return static_cast<unsigned char>(c) >= 0x20 && c != 0x7f; });
        if (line.empty() || line.size() > kLongest || !plain) {
            throw BadInput("operate", "--job", "'" + line.substr(0, kLongest) + "'",
                           "a line of 1 to 100 bytes without control characters");
        }
    }
}

// One window; returns what the pilot opens next.
std::string runWindow(const OperateOptions& options, const GlobalOptions& global) {
    if (options.recording.empty()) {
        operate::OperatorRun live(options, global);
        live.run();
        return live.next();
    }
    operate::PlaybackRun past(options, global);
    past.run();
    return past.next();
}

OperateOptions optionsFor(const OperateOptions& first, const std::string& recording) {
    OperateOptions next = first;
    next.recording = recording;
    next.scene = std::filesystem::path(recording) / "scene.yaml";
    next.source.clear(), next.handDevice.clear(), next.arm.clear(), next.pilot.clear();
    next.observers = {};
    next.armed = next.path = false;
    next.fromLiveRun = first.recording.empty();
    return next;
}

// A recording that cannot be opened from a live run leads back to it, with the reason.
void runWindows(const OperateOptions& first, const GlobalOptions& global) {
    OperateOptions now = first;
    for (bool again = false;; again = true) {
        now.appendsState = again;
        std::string next;
        try {
            next = runWindow(now, global);
        } catch (const BadInput& e) {
            if (!now.fromLiveRun) {
                throw;
            }
            now = first;
            now.notice = e.what();
            continue;
        }
        if (next.empty()) {
            return;
        }
        now = next == operate::kLiveRun ? first : optionsFor(first, next);
    }
}

// Opens what the options ask for; for a recording's folder its scene.
void runOperate(OperateOptions& options, const GlobalOptions& global) {
    if (std::filesystem::is_directory(options.scene)) {
        options.recording = options.recording.empty() ? options.scene.string() : options.recording;
        options.scene /= "scene.yaml";
        if (!std::filesystem::exists(options.scene)) {
            throw BadInput(options.scene.parent_path().string(), "scene.yaml", "none",
                           "a scene file, or a folder that the window recorded; other recordings are opened "
                           "by operate SCENE --recording FOLDER");
        }
    }
    checkJob(options.job);
    for (const auto& [name, value] :
         {std::pair("--source", &options.source), std::pair("--hand-device", &options.handDevice),
          std::pair("--arm", &options.arm), std::pair("--view-door", &options.observers.viewEndpoint),
          std::pair("--ros2", &options.observers.ros2)}) {
        if (!options.recording.empty() && !value->empty()) {
            throw BadInput("operate", name, *value, "nothing beside a recording");
        }
    }
    noteInput(options.scene);
    noteInput(options.source);
    refuseInput(options.state);                                 // before a window opens
    options.armed = options.path && !options.offscreen.empty(); // offscreen no key can arm forces
    runWindows(options, global);
}

} // namespace

void addOperateCommand(CLI::App& app, const GlobalOptions& global) {
    auto options = std::make_shared<OperateOptions>();
    CLI::App* command = app.add_subcommand("operate", "the operator's window on a live or recorded camera");
    command
        ->add_option("SCENE", options->scene,
                     "scene file (YAML), or the folder of a recording with its scene.yaml")
        ->required();
    command->add_option("--recording", options->recording, "show this recording on a time line");
    command->add_option("--source", options->source, kSourceHelp);
    command->add_option("--hand-device", options->handDevice, kHandHelp);
    command->add_flag("--path", options->path, "the scene's hand path moves the tool, not mouse and keyboard")
        ->excludes("--hand-device");
    command->add_option("--arm", options->arm, kArmHelp);
    command->add_option("--view-door", options->observers.viewEndpoint, kViewEndpointHelp);
    command->add_option("--ros2", options->observers.ros2, kRos2Help);
    command->add_option("--offscreen", options->offscreen,
                        "WxH: draw without a display; with --folder, end with a screenshot");
    command
        ->add_option("--seconds", options->seconds, "end after this time [s] (0: when the window is closed)")
        ->check(numberIn(Range::between(0.0, 604800.0)));
    command->add_option("--pilot", options->pilot,
                        "use stiffness, limits and scale of this pilot of the scene");
    command
        ->add_option("--text-scale", options->textScale,
                     "text size, 0.75 to 2.5 (1: as the monitor's resolution needs it)")
        ->check(numberIn(Range::between(0.75, 2.5)));
    command->add_option("--state", options->state,
                        "write what the window shows to this file, one JSON object per line");
    command
        ->add_option("--job", options->job,
                     "a line under exported images, such as vessel or task; give it at most twice")
        ->allow_extra_args(false);
    command->add_option("--folder", options->shots,
                        "folder for screenshots, traces, recordings and exports (default: the current one)");
    command->callback([options, &global] { runOperate(*options, global); });
}

} // namespace fathom
