// SPDX-License-Identifier: Apache-2.0
// Group guarantee: no leaf enters a region, for any hand motion and any delay of the contact answers.
#include "apps/stability/case_text.h"
#include "apps/stability/hand_run.h"
#include "devices/simulated/analytic_scene.h"
#include "engine/types/angle.h"

#include <array>

namespace fathom::stability {

namespace {

constexpr double kLimit = 1e-5;                            // [m]
constexpr std::array<double, 3> kSpeeds{0.05, 0.5, 5.0};   // [m/s]
constexpr std::array<uint32_t, 5> kLate{0, 1, 5, 20, 100}; // [ms]
constexpr double kTwentyTurns = 20.0 * kTurn;              // [rad/s]

int ticksPerRun(RunLength runLength, int full) {
    return runLength == RunLength::Full ? full : full / 30;
}

// Runs all speeds with all delays of the answers; the short form runs one speed per delay.
Outcome anyHand(const World& world, RunLength runLength, const std::string& what) {
    HandRunFigures all;
    Outcome::Curve stalls{"stalled ticks", "answer delay [ms]", "share of the ticks", {}, {}, false, false};
    for (size_t late = 0; late < kLate.size(); ++late) {
        HandRunFigures some;
        for (size_t s = 0; s < kSpeeds.size(); ++s) {
            if (runLength == RunLength::Short && s != late % kSpeeds.size()) {
                continue;
            }
            HandRun handRun;
            handRun.motion.speed = kSpeeds[s];
            handRun.motion.spin = s == 2 ? kTwentyTurns : 20.0;
            handRun.motion.turnOvers = 2.0;
            handRun.faults = {kLate[late], false, late % 2 == 1 ? 0.3 : 0.0};
            handRun.ticks = ticksPerRun(runLength, 30000);
            handRun.seed = 100 * late + s;
            runHand(world, handRun, some);
        }
        stalls.x.push_back(kLate[late]);
        stalls.y.push_back(static_cast<double>(some.rig.stalled) / static_cast<double>(some.rig.ticks));
        all.add(some);
    }
    Outcome out = penetrationOutcome(
        all, kLimit,
        what + " Hands of 0.05, 0.5 and 5 m/s that leap up to 10 m and turn over; answers late by 0, "
               "1, 5, 20 and 100 ms, 30 % of them lost at 1 and 20 ms. ");
    out.curves.push_back(std::move(stalls));
    return out;
}

// One hand motion in every synthetic world.
Outcome anyWorld(const HandMotion& motion, const AnswerFaults& faults, RunLength runLength,
                 const std::string& what) {
    HandRunFigures all;
    const std::array<World, 5> worlds{wallWorld(), cornerWorld(), slotWorld(), grooveWorld(20.0),
                                      rubbleWorld()};
    for (size_t w = 0; w < worlds.size(); ++w) {
        HandRun handRun;
        handRun.motion = motion;
        handRun.faults = faults;
        handRun.ticks = ticksPerRun(runLength, 30000);
        handRun.seed = w + 1;
        runHand(worlds[w], handRun, all);
    }
    return penetrationOutcome(all, kLimit, what + " Wall, corner, slot, groove and rubble. ");
}

void addWorldCases(std::vector<Case>& cases) {
    for (const std::string& scene : analyticSceneNames()) {
        cases.push_back({"guarantee-scene-" + scene, Group::Guarantee, [scene](RunLength runLength) {
                             return anyHand(analyticWorld(scene, 0.04, true), runLength,
                                            "Analytic scene '" + scene +
                                                "' with camera noise, regions of 40 mm, 9 leaves.");
                         }});
    }
    const std::array<std::array<const char*, 2>, 3> recordings{
        {{"apps/scenes/valve_globe.yaml", "valve_globe_d435"},
         {"apps/scenes/valve_ball.yaml", "valve_ball_d435"},
         {"apps/scenes/ycb.yaml", "ycb_posecnn_demo"}}};
    for (const auto& [file, folder] : recordings) {
        if (!std::filesystem::exists(recordingFolder(folder)) || !std::filesystem::exists(file)) {
            continue; // skips missing recordings
        }
        cases.push_back({std::string("guarantee-recording-") + folder, Group::Guarantee,
                         [file = std::string(file), folder = std::string(folder)](RunLength runLength) {
                             return anyHand(
                                 recordedWorld(file, folder).value(), runLength,
                                 "First frame of the recording " + folder +
                                     ", its regions made on the CPU by the float64 twins of the passes.");
                         }});
    }
}

} // namespace

std::vector<Case> guaranteeCases() {
    std::vector<Case> cases;
    const auto put = [&](const std::string& name, const HandMotion& motion, const AnswerFaults& faults,
                         const std::string& what) {
        cases.push_back({"guarantee-" + name, Group::Guarantee,
                         [=](RunLength runLength) { return anyWorld(motion, faults, runLength, what); }});
    };
    const HandMotion plain{};
    put("speed-005", {0.05, 2.0, 0.0, 0.0, 8.0, 0.0}, {}, "Hand of 0.05 m/s that jumps to random places.");
    put("speed-05", {0.5, 5.0, 0.0, 0.0, 4.0, 0.0}, {}, "Hand of 0.5 m/s.");
    put("speed-5", {5.0, 20.0, 0.0, 0.0, 4.0, 0.0}, {}, "Hand of 5 m/s.");
    put("leaps-10m", {0.5, 5.0, 20.0, 10.0, 20.0, 0.0}, {}, "20 leaps of up to 10 m per second.");
    put("half-turns", {0.5, 0.0, 0.0, 0.0, 8.0, 30.0}, {},
        "30 rotations by 180 degrees per second, each at once.");
    put("twenty-turns-a-second", {0.5, kTwentyTurns, 0.0, 0.0, 8.0, 0.0}, {},
        "Rotation at 10 to 20 turns per second.");
    for (const uint32_t late : kLate) {
        put("answers-late-" + std::to_string(late) + "ms", plain, {late, false, 0.0},
            "Answers late by " + std::to_string(late) + " ms.");
    }
    put("answers-jitter-100ms", plain, {100, true, 0.0},
        "Answers late by 0 to 100 ms, at random for each answer.");
    put("answers-lost-half", plain, {0, false, 0.5}, "Half of the answers lost.");
    put("answers-lost-95", plain, {20, true, 0.95}, "95 % of the answers lost, the rest late by 0 to 20 ms.");
    addWorldCases(cases);
    return cases;
}

} // namespace fathom::stability
