// SPDX-License-Identifier: Apache-2.0
#include "apps/replay/replay_command.h"

#include "apps/binding/arm_thread.h"
#include "apps/binding/open_hand.h"
#include "apps/binding/open_source.h"
#include "apps/number_option.h"
#include "apps/replay/budgets.h"
#include "apps/replay/lockstep_replay.h"
#include "apps/replay/realtime_replay.h"
#include "devices/ros2/ros2_output_request.h"
#include "engine/types/error.h"

#include <CLI/CLI.hpp>
#include <cmath>
#include <iomanip>
#include <iostream>
#include <memory>
#include <sstream>

namespace fathom {

namespace {

constexpr double kPenetrationLimit = 1e-5; // [m] limit of the penetration in every run

// Four digits, but never an exponent for a large number.
std::string decimal(double x) {
    std::ostringstream text;
    if (std::abs(x) >= 1e4) {
        text << std::fixed << std::setprecision(0) << x;
    } else {
        text << std::setprecision(4) << x;
    }
    return text.str();
}

void printPart(const char* name, const Percentiles& p, const char* unit) {
    if (p.p50) {
        std::cout << name << " p50 " << decimal(*p.p50) << " p99 " << decimal(*p.p99) << " max "
                  << decimal(*p.max) << " " << unit << "\n";
    }
}

void print(const ReplaySummary::Arm& arm) {
    std::cout << "arm          " << arm.leaves << " leaves on " << arm.links.size() << " links, "
              << arm.joints.size() << " joints; at a limit in " << arm.limitedTicks << " ticks, singular in "
              << arm.singularTicks << ", limits exceeded by " << arm.limitViolation << "\n";
    for (const std::string& line : arm.description) {
        std::cout << "  " << line << "\n";
    }
    printPart("  residual  ", arm.residual, "m");
    for (const auto& link : arm.links) {
        if (link.penetration) {
            std::cout << "  link       " << link.name << ": " << link.leaves << " leaves, "
                      << *link.penetration * 1e6 << " um deep\n";
        }
    }
}

void print(const ReplaySummary& s, const std::filesystem::path& out) {
    std::cout << std::setprecision(4);
    std::cout << "frames       " << s.frames.count << " used, " << s.frames.skipped << " skipped on "
              << s.device << "\n";
    if (s.frames.first) {
        std::cout << "  first set  " << *s.frames.first << " s after program start\n";
    }
    printPart("  passes    ", s.frames.gpuMs, "ms");
    printPart("  latency   ", s.frames.latencyMs, "ms");
    std::cout << "haptic       " << s.haptic.ticks << " ticks, " << s.haptic.stalledTicks << " stalled, "
              << s.haptic.trappedTicks << " trapped, " << s.haptic.escapeTicks << " escaping\n";
    printPart("  step      ", s.haptic.stepMicros, "us");
    printPart("  query     ", s.contact.queryMicros, "us");
    std::cout << "  force      up to " << s.haptic.maxForce << " N, torque up to " << s.haptic.maxTorque
              << " N m, stiffness " << s.haptic.stiffness.value_or(0.0) << " N/m\n"
              << "  penetration ";
    if (s.haptic.maxPenetration) {
        std::cout << *s.haptic.maxPenetration * 1e6 << " um\n";
    } else {
        std::cout << "not audited\n";
    }
    if (s.arm) {
        print(*s.arm);
    }
    for (const auto& f : s.fixtures) {
        std::cout << "fixture      " << f.name << " (" << f.role << "): " << f.pointsMean.value_or(0.0)
                  << " points, " << f.spheresMean.value_or(0.0) << " spheres per frame\n";
    }
    for (const std::string& warning : s.warnings) {
        std::cout << "warning      " << warning << "\n";
    }
    std::cout << "digest       " << s.digest << "\nwritten to   " << out.string() << "\n";
}

void printBudgets(const ReplaySummary& summary, const Session& session) {
    const size_t leaves = summary.arm ? summary.arm->leaves : session.tool.leafCount();
    for (const BudgetFigure& f :
         budgetFigures(summary, session.camera->info().depth, session.cycles.facts().kind, leaves)) {
        std::cout << "budget       " << f.what << " " << decimal(f.measured) << " " << f.unit << ", at most "
                  << f.budget << " " << f.unit << (f.note.empty() ? "" : " (" + f.note + ")")
                  << (f.holds() ? ", met\n" : ", MISSED\n");
    }
}

void print(const RealtimeFigures& f, const ThreadPlacement& placement, const ReplaySummary& s) {
    std::cout << "realtime     " << describe(placement) << (f.stopped ? "; stopped by a signal" : "") << "\n";
    printPart("  woken late", f.wokenLateMicros, "us");
    printPart("  exposed   ", f.exposureMs, "ms before the set was published");
    std::cout << "  ticks     " << s.haptic.late << " of " << s.haptic.ticks
              << " ended over one period late, " << f.periodsMissed << " periods without one\n  frames    "
              << f.framesLost << (f.live ? " lost" : " that a live camera would have lost") << ", "
              << f.framesInPlace << " read where the camera left them; scene too old in " << f.staleTicks
              << " ticks\n";
    if (f.renewals > 0) {
        std::cout << "  device    lost and reopened " << f.renewals << " times\n";
    }
    if (f.recordsLost > 0) {
        std::cout << "  records   " << f.recordsLost << " lost: the writer could not keep up\n";
    }
}

void print(const ReplaySummary::Arm::Driven& driven) {
    std::cout << "real arm     " << driven.description << ": at the end " << driven.lastState << "; ticks";
    for (const auto& [state, ticks] : driven.ticks) {
        std::cout << (&state == &driven.ticks.front().first ? " " : ", ") << ticks << " " << state;
    }
    std::cout << "\n  line      " << driven.damaged << " frames damaged, opened again " << driven.reopened
              << " times, feedback up to " << driven.oldest * 1e3 << " ms old\n";
    printPart("  tip behind", driven.tipLag, "m");
}

void print(const LiveHand& hand) {
    const LiveHandFigures f = hand.figures();
    std::cout << "hand         " << hand.description() << ": " << axesOf(hand.preset()) << "\n  samples   "
              << f.samples << ", oldest used " << f.worstAge * 1e3 << " ms; lost " << f.losses << " times, "
              << f.unsent << " wrenches not taken\n";
}

std::unique_ptr<CadenceTrace> openTrace(const Session& session, const GlobalOptions& global) {
    return global.trace.empty()
               ? nullptr
               : std::make_unique<CadenceTrace>(global.trace, session.cycles.frames().passNames());
}

ReplaySummary runLockstep(const ReplayOptions& options, const GlobalOptions& global) {
    Session session(options, global);
    const auto trace = openTrace(session, global);
    ReplayRecorder recorder(options.out, session.scene, {session.cycles.camera(), session.camera->streams()},
                            session.cycles.frames().passNames(), options.saveFixtures, session.arm.get(), "",
                            &session.edits);
    LockstepReplay replay(session, options, recorder, trace.get());
    const ReplaySummary summary = recorder.finish(replay.run());
    if (trace) {
        trace->file().finish();
    }
    print(summary, options.out);
    printBudgets(summary, session);
    return summary;
}

ReplaySummary runRealtime(const ReplayOptions& options, const GlobalOptions& global) {
    const ThreadPlacement placement = ThreadPlacement::ofThisProcess();
    const CpuConfinement confined(placement.rest); // inherited by a software device's workers
    Session session(options, global);
    if (options.frameRate > 0.0 && session.camera->live()) {
        throw BadInput("replay", "--picture-rate", std::to_string(options.frameRate),
                       "with a recording or a simulated camera: a live one has a rate of its own");
    }
    const auto trace = openTrace(session, global);
    ReplayRecorder recorder(options.out, session.scene, {session.cycles.camera(), session.camera->streams()},
                            session.cycles.frames().passNames(), options.saveFixtures, session.arm.get(),
                            session.realArm ? session.realArm->description() : "", &session.edits);
    RealtimeReplay replay(session, options, recorder, placement, trace.get());
    const ReplaySummary summary = recorder.finish(replay.run());
    if (trace) {
        trace->file().finish();
    }
    replay.rethrowFailure();
    print(summary, options.out);
    printBudgets(summary, session);
    print(replay.figures(), placement, summary);
    if (session.liveHand) {
        print(*session.liveHand);
    }
    if (summary.arm && summary.arm->driven) {
        print(*summary.arm->driven);
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

int runReplay(const ReplayOptions& asked, const GlobalOptions& global) {
    const ReplayOptions options = withFolder(asked);
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
        throw BadInput("replay", "--picture-rate", std::to_string(options.frameRate),
                       "together with --realtime");
    }
    if (options.seconds > 0.0 && options.handDevice.empty()) {
        throw BadInput("replay", "--seconds", decimal(options.seconds), "together with --hand-device");
    }
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
        ->add_option("--picture-rate", options->frameRate,
                     "with --realtime: frames per second of a recording or simulated camera (default 30)")
        ->check(numberIn(Range::between(1.0, 240.0)));
    command->add_flag(
        "--strict", options->strict,
        "exit code 1 if the run had warnings: a class without points, skipped frames, no force");
    command->add_flag("--save-fixtures", options->saveFixtures, "write fixtures/NNNNNN.ply for every frame");
    command->add_option("--out", options->out, "output folder; its files are replaced")->required();
    command->callback([options, &global, &result] { result = runReplay(*options, global); });
}

} // namespace fathom
