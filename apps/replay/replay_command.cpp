// SPDX-License-Identifier: Apache-2.0
#include "apps/replay/replay_command.h"

#include "apps/binding/arm_thread.h"
#include "apps/binding/open_hand.h"
#include "apps/binding/open_source.h"
#include "apps/binding/stop_signals.h"
#include "apps/number_option.h"
#include "apps/replay/lockstep_replay.h"
#include "apps/replay/realtime_replay.h"
#include "apps/replay/replay_report.h"
#include "devices/ros2/ros2_output_request.h"
#include "engine/types/error.h"
#include "engine/types/input_files.h"

#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>

namespace fathom {

namespace {

constexpr double kPenetrationLimit = 1e-5; // [m] limit of the penetration in every run

std::unique_ptr<CadenceTrace> openTrace(const Session& session, const GlobalOptions& global) {
    return global.trace.empty()
               ? nullptr
               : std::make_unique<CadenceTrace>(global.trace, session.cycles.frames().passNames());
}

// realArm: its description; empty = none.
ReplayRecorder recorderOf(Session& session, const ReplayOptions& options, const std::string& realArm) {
    return ReplayRecorder(options.out, session.scene, {session.cycles.camera(), session.camera->streams()},
                          session.cycles.frames().passNames(), options.saveFixtures, session.arm.get(),
                          realArm, &session.edits);
}

void report(const ReplaySummary& summary, const ReplayOptions& options, const Session& session) {
    printSummary(summary, options.out);
    printBudgets(summary, session);
}

ReplaySummary runLockstep(const ReplayOptions& options, const GlobalOptions& global) {
    Session session(options, global);
    const StopSignals signals; // until the files are complete
    const auto trace = openTrace(session, global);
    ReplayRecorder recorder = recorderOf(session, options, "");
    LockstepReplay replay(session, options, recorder, signals.requested(), trace.get());
    const ReplaySummary summary = recorder.finish(replay.run());
    if (trace) {
        trace->file().finish();
    }
    report(summary, options, session);
    return summary;
}

ReplaySummary runRealtime(const ReplayOptions& options, const GlobalOptions& global) {
    const ThreadPlacement placement = ThreadPlacement::ofThisProcess();
    const CpuConfinement confined(placement.rest); // inherited by a software device's workers
    Session session(options, global);
    if (options.frameRate > 0.0 && session.camera->live()) {
        throw BadInput("replay", "--frame-rate", std::to_string(options.frameRate),
                       "with a recording or a simulated camera: a live one has a rate of its own");
    }
    const auto trace = openTrace(session, global);
    ReplayRecorder recorder =
        recorderOf(session, options, session.realArm ? session.realArm->description() : "");
    RealtimeReplay replay(session, options, recorder, placement, trace.get());
    const ReplaySummary summary = recorder.finish(replay.run());
    if (trace) {
        trace->file().finish();
    }
    replay.rethrowFailure();
    report(summary, options, session);
    printRealtime(replay.figures(), placement, summary);
    if (session.liveHand) {
        printHand(*session.liveHand);
    }
    if (summary.arm && summary.arm->driven) {
        printDrivenArm(*summary.arm->driven);
    }
    if (session.realArm && session.realArm->gone()) {
        throw DeviceLost(session.realArm->description() + ": gone");
    }
    return summary;
}

// SCENE may be the folder of a recording. Its own scene, frames and hand are then the defaults.
ReplayOptions withFolder(ReplayOptions options) {
    const std::filesystem::path folder = options.scene;
    if (!std::filesystem::is_directory(folder)) {
        return options;
    }
    options.scene = folder / "scene.yaml";
    if (!std::filesystem::exists(options.scene)) {
        throw BadInput(folder.string(), "scene.yaml", "none",
                       "a scene file, or a folder that the window recorded; other recordings are played "
                       "with a scene file and --source");
    }
    if (options.source.empty()) {
        options.source = folder.string();
    }
    const bool otherHand = options.hand || !options.operatorCsv.empty() || !options.handDevice.empty();
    if (!otherHand && std::filesystem::exists(folder / "hand.csv")) {
        options.operatorCsv = folder / "hand.csv";
    }
    return options;
}

int runReplay(const ReplayOptions& requested, const GlobalOptions& global) {
    const ReplayOptions options = withFolder(requested);
    for (const auto& [name, value] :
         {std::pair("--hand-device", &options.handDevice),
          std::pair("--view-door", &options.observers.viewEndpoint),
          std::pair("--ros2", &options.observers.ros2), std::pair("--arm", &options.arm)}) {
        if (!value->empty() && !options.realtime) {
            throw BadInput("replay", name, *value, "together with --realtime");
        }
    }
    if (!options.observers.ros2.empty() && parseRos2OutputRequest(options.observers.ros2).commands) {
        throw BadInput("replay", "--ros2", options.observers.ros2, "commands=on only with operate");
    }
    if (options.frameRate > 0.0 && !options.realtime) {
        throw BadInput("replay", "--frame-rate", std::to_string(options.frameRate),
                       "together with --realtime");
    }
    if (options.seconds > 0.0 && options.handDevice.empty()) {
        throw BadInput("replay", "--seconds", decimal(options.seconds), "together with --hand-device");
    }
    noteInput(options.operatorCsv); // it is read after the outputs were opened
    const ReplaySummary summary =
        options.realtime ? runRealtime(options, global) : runLockstep(options, global);
    if (summary.haptic.maxPenetration.value_or(0.0) > kPenetrationLimit) {
        std::cerr << "fathom: max_penetration_m " << *summary.haptic.maxPenetration << " exceeds "
                  << kPenetrationLimit << "\n";
        return 1;
    }
    if (options.strict && !summary.warnings.empty()) {
        std::cerr << "fathom: --strict: " << summary.warnings.size()
                  << " warnings; the first: " << summary.warnings.front() << "\n";
        return 1;
    }
    return 0;
}

} // namespace

void addReplayCommand(CLI::App& app, const GlobalOptions& global, int& result) {
    auto options = std::make_shared<ReplayOptions>();
    CLI::App* command = app.add_subcommand("replay", "run frames and a hand through the engine, headless");
    command->add_option("SCENE", options->scene, "scene file (YAML), or the folder of a recording")
        ->required();
    command->add_option("--source", options->source, kSourceHelp);
    command->add_option("--operator", options->operatorCsv, "hand path: CSV t_s,x,y,z,qw,qx,qy,qz[,button]");
    command->add_flag("--hand", options->hand,
                      "the hand yields to the force: the simulated hand of hand.loop");
    command->add_option("--hand-device", options->handDevice, kHandHelp)->excludes("--operator", "--hand");
    command->add_option("--view-door", options->observers.viewEndpoint, kViewEndpointHelp);
    command->add_option("--ros2", options->observers.ros2, kRos2Help);
    command->add_option("--arm", options->arm, kArmHelp);
    command
        ->add_option("--seconds", options->seconds,
                     "with --hand-device: run for this time [s], on the last frame once the source has ended")
        ->check(numberIn(Range::between(0.0, 604800.0)));
    command
        ->add_option("--query", options->query,
                     "device that finds contacts (default: the scene's contact.where)")
        ->check(wordIn({"cpu", "gpu"}));
    command->add_flag("--realtime", options->realtime,
                      "run on threads and the real clock instead of in lockstep");
    command
        ->add_option("--frame-rate,--picture-rate", options->frameRate,
                     "with --realtime: frames per second of a recording or simulated camera (default 30)")
        ->check(numberIn(Range::between(1.0, 240.0)));
    command->add_flag(
        "--strict", options->strict,
        "exit code 1 if the run had warnings: a class without points, skipped frames, no force, a signal");
    command->add_flag("--save-fixtures", options->saveFixtures, "write fixtures/NNNNNN.ply for every frame");
    command->add_option("--out", options->out, "output folder; its files are replaced")->required();
    command->callback([options, &global, &result] { result = runReplay(*options, global); });
}

} // namespace fathom
