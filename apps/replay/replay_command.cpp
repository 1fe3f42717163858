// SPDX-License-Identifier: Apache-2.0
#include "apps/replay/replay_command.h"

#include "apps/replay/lockstep_replay.h"

#include <iomanip>
#include <iostream>
#include <memory>

namespace fathom {

namespace {

constexpr double kPenetrationLimit = 1e-5; // [m] the stated limit of lockstep runs

void printPart(const char* name, const Percentiles& p, const char* unit) {
    if (p.p50) {
        std::cout << name << " p50 " << *p.p50 << " p99 " << *p.p99 << " max " << *p.max << " " << unit << "\n";
    }
}

void print(const ReplaySummary& s, const std::filesystem::path& out) {
    std::cout << std::setprecision(4);
    std::cout << "frames       " << s.frames.count << " used, " << s.frames.skipped << " skipped on " << s.device << "\n";
    printPart("  passes    ", s.frames.gpuMs, "ms");
    printPart("  latency   ", s.frames.latencyMs, "ms");
    std::cout << "haptic       " << s.haptic.ticks << " ticks, " << s.haptic.stalledTicks << " stalled, " << s.haptic.trappedTicks
              << " trapped, " << s.haptic.escapeTicks << " escaping\n";
    printPart("  turn      ", s.haptic.turnMicros, "us");
    printPart("  query     ", s.contact.queryMicros, "us");
    std::cout << "  force      up to " << s.haptic.maxForce << " N, torque up to " << s.haptic.maxTorque << " N m, stiffness "
              << s.haptic.stiffness.value_or(0.0) << " N/m\n"
              << "  penetration " << s.haptic.maxPenetration.value_or(0.0) * 1e6 << " um beyond the allowance\n";
    for (const auto& f : s.fixtures) {
        std::cout << "fixture      " << f.name << " (" << f.role << "): " << f.pointsMean.value_or(0.0) << " points, "
                  << f.spheresMean.value_or(0.0) << " spheres a frame\n";
    }
    std::cout << "digest       " << s.digest << "\nwritten to   " << out.string() << "\n";
}

int runReplay(const ReplayOptions& options, const GlobalOptions& global) {
    ReplaySession session(options, global, 2);
    ReplayRecorder recorder(options.out, session.scene, session.frames.passNames(), options.saveFixtures);
    LockstepReplay replay(session, options, recorder);
    const ReplaySummary summary = recorder.finish(replay.run());
    print(summary, options.out);
    if (summary.haptic.maxPenetration.value_or(0.0) > kPenetrationLimit) {
        std::cerr << "fathom: max_penetration_m " << *summary.haptic.maxPenetration << " exceeds " << kPenetrationLimit << "\n";
        return 1;
    }
    return 0;
}

} // namespace

void addReplayCommand(CLI::App& app, const GlobalOptions& global, int& result) {
    auto options = std::make_shared<ReplayOptions>();
    CLI::App* command = app.add_subcommand("replay", "run frames and a hand through the engine, headless");
    command->add_option("SCENE", options->scene, "scene file (YAML)")->required();
    command->add_option("--source", options->source, "recording folder in place of the scene's camera");
    command->add_option("--operator", options->operatorCsv, "hand path: CSV t_s,x,y,z,qw,qx,qy,qz[,button]");
    command->add_flag("--hand", options->hand, "close the loop with the simulated hand of hand.loop");
    command->add_option("--query", options->query, "where contacts are found")->check(CLI::IsMember({"cpu", "gpu"}));
    command->add_flag("--save-fixtures", options->saveFixtures, "write fixtures/NNNNNN.ply of every frame");
    command->add_option("--out", options->out, "output folder; its files are replaced")->required();
    command->callback([options, &global, &result] { result = runReplay(*options, global); });
}

} // namespace fathom
