// SPDX-License-Identifier: Apache-2.0
// `replay --realtime --arm PORT`: the program drives a simulated arm on a serial line, with line and motor
// faults.
#include "tests/rig/arm_stage.h"

#include <cmath>
#include <doctest/doctest.h>
#include <future>
#include <glm/geometric.hpp>
#include <sstream>

using namespace fathom;
using namespace fathom::testing;

namespace {

struct Driven {
    ProgramRun run;
    nlohmann::json arm; // arm.driven of summary.json; null when there is none
    nlohmann::json haptic;
    std::vector<std::pair<double, std::string>> states; // arm.csv: t, real_arm

    uint64_t turns(const std::string& state) const { return arm.at("turns").at(state).get<uint64_t>(); }
};

Driven readDriven(const Stage& stage, const ProgramRun& run) {
    Driven driven{run, nullptr, nullptr, {}};
    if (!std::filesystem::exists(stage / "out/summary.json")) {
        return driven;
    }
    const auto summary = nlohmann::json::parse(stage.read("out/summary.json"));
    driven.arm = summary.at("arm").at("driven");
    driven.haptic = summary.at("haptic");
    std::istringstream file(stage.read("out/arm.csv"));
    std::string line;
    std::getline(file, line);
    CHECK(line.find(",real_arm,measured_slew,measured_shoulder,measured_elbow") != std::string::npos);
    while (std::getline(file, line)) {
        std::vector<std::string> cells;
        std::istringstream text(line);
        for (std::string cell; std::getline(text, cell, ',');) {
            cells.push_back(cell);
        }
        REQUIRE(cells.size() == 16);
        driven.states.emplace_back(std::strtod(cells[0].c_str(), nullptr), cells[11]);
    }
    return driven;
}

// Runs the program while `meanwhile` changes the arm.
template <class Meanwhile>
Driven drive(const Stage& stage, Meanwhile&& meanwhile) {
    auto running = std::async(std::launch::async, [&] {
        return runFathom(stage.command({"--realtime", "--arm", (stage / "line").string()}));
    });
    meanwhile();
    return readDriven(stage, running.get());
}

void checkHeld(const Driven& driven) {
    CHECK(driven.haptic.at("max_penetration_m").get<double>() <= 1e-5);
    CHECK(driven.arm.at("turns").size() == 7);
}

} // namespace

TEST_CASE("The program drives an arm on a serial line up to a region, and leaves it at rest") {
    for (const LineFaults& faults : {LineFaults{}, LineFaults{0.001, 0.001, true, 0.01}}) {
        const Stage stage;
        setUp(stage, kReach, pushing(4.5));
        ReachSimulator arm;
        setStart(arm);
        ArmBench bench(arm, stage / "line");
        bench.faults(faults);
        const Driven driven = drive(stage, [] {});
        REQUIRE_MESSAGE(driven.run.exitCode == 0, driven.run.err);
        checkHeld(driven);
        CHECK(driven.turns("follows") > 1000);
        CHECK(driven.run.out.find("Reach Alpha 5 on ") != std::string::npos);
        const auto q = bench.with([&] { return jointsOf(arm); });
        const double z = tipDepth(q);
        MESSAGE("tip at " << z << " m of 0.54, tip behind the tool p99 "
                          << driven.arm.at("tip_lag_m").at("p99").get<double>() * 1e3 << " mm, "
                          << driven.arm.at("frames_damaged") << " frames damaged");
        CHECK(z > tipDepth({kStart[0], kStart[1], kStart[2]}) + 0.1); // it moved
        CHECK(z < 0.541);
        if (faults.noise == 0.0) {
            CHECK(z > 0.535); // and rests on the region, 57 mm before the hand
            CHECK(driven.haptic.at("max_force_N").get<double>() > 5.0);
        } else {
            CHECK(driven.arm.at("frames_damaged").get<uint64_t>() > 0);
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(300));
        CHECK(bench.with([&] { return jointsOf(arm); }) == q);
        CHECK(bench.with([&] { return arm.position[1]; }) == 7.0); // the jaws stay
    }
}

TEST_CASE("An ECA is homed against its stops and then driven, wherever its encoders wrap around") {
    const Stage stage;
    setUp(stage, kEca, pushing(4.5));
    stage.write("scene.yaml",
                stage.read("scene.yaml") +
                    "  joints: [{name: slew, speed: 0.25}, {name: shoulder, speed: 0.25, lower: 0.8}, "
                    "{name: elbow, speed: 0.25, lower: 0.4}]\n");
    EcaSimulator arm;
    arm.lower.fill(0.0);
    arm.upper.fill(1.6);
    arm.angle.fill(0.04);
    arm.firstCount.fill(65500);
    ArmBench bench(arm, stage / "line");
    const Driven driven = drive(stage, [] {});
    REQUIRE_MESSAGE(driven.run.exitCode == 0, driven.run.err);
    checkHeld(driven);
    CHECK(driven.run.err.find("homing: each joint moves to its stop") != std::string::npos);
    CHECK(driven.turns("follows") > 1000);
    const auto q = bench.with([&] {
        return std::array{-0.9 - arm.angle[1], 0.8 + arm.angle[0], 0.4 + arm.angle[2]};
    });
    MESSAGE("tip at " << tipDepth(q) << " m");
    CHECK(tipDepth(q) > tipDepth({kStart[0], kStart[1], kStart[2]}) + 0.05);
    CHECK(tipDepth(q) < 0.545);
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    CHECK(bench.with([&] { return -0.9 - arm.angle[1]; }) == q[0]);
}

TEST_CASE("A line that falls silent holds tool and arm, and both resume when it is back") {
    const Stage stage;
    setUp(stage, kReach, pushing(6.0));
    ReachSimulator arm;
    setStart(arm);
    ArmBench bench(arm, stage / "line");
    std::array<double, 3> atCut{}, after{};
    const Driven driven = drive(stage, [&] {
        REQUIRE(bench.wait([&] { return tipDepth(jointsOf(arm)) > 0.45; })); // it is moving
        LineFaults cut;
        cut.cut = true;
        bench.faults(cut);
        atCut = bench.with([&] { return jointsOf(arm); });
        std::this_thread::sleep_for(std::chrono::milliseconds(1000));
        after = bench.with([&] { return jointsOf(arm); });
        bench.faults({});
    });
    REQUIRE_MESSAGE(driven.run.exitCode == 0, driven.run.err);
    checkHeld(driven);
    CHECK(driven.turns("silent") > 300);
    int spokeAgain = 0;
    bool silent = false;
    for (const auto& [t, state] : driven.states) {
        silent = silent || state == "silent";
        spokeAgain += silent && state == "follows" ? 1 : 0;
    }
    CHECK(spokeAgain > 100);
    CHECK(driven.run.err.find("silent: the arm and the tool are held, forces fade out") != std::string::npos);
    for (size_t k = 0; k < 3; ++k) {
        CHECK(std::abs(after[k] - atCut[k]) < 0.06); // at most to the last setpoint, 0.05 rad ahead
    }
    // The tool is still in these ticks, and without force after 200 of them.
    const std::vector<Tick> ticks = readTicks(stage / "out/haptics.csv");
    REQUIRE(ticks.size() == driven.states.size());
    uint64_t inARow = 0, still = 0;
    for (size_t i = 1; i < ticks.size(); ++i) {
        inARow = driven.states[i].second == "silent" ? inARow + 1 : 0;
        if (inARow > 1) {
            CHECK(ticks[i].tool.position == ticks[i - 1].tool.position);
        }
        if (inARow > 210) {
            CHECK(glm::length(ticks[i].force) == 0.0);
            CHECK(ticks[i].state == "off");
            ++still;
        }
    }
    CHECK(still > 50);
    CHECK(bench.with([&] { return tipDepth(jointsOf(arm)); }) > tipDepth(after) + 0.01); // it resumed
}

TEST_CASE("An arm that is unplugged ends the run with exit code 3; one that comes back resumes") {
    for (const bool back : {false, true}) {
        CAPTURE(back);
        const Stage stage;
        setUp(stage, kReach, pushing(5.0));
        ReachSimulator arm;
        setStart(arm);
        ArmBench bench(arm, stage / "line");
        std::array<double, 3> atCut{};
        const Driven driven = drive(stage, [&] {
            REQUIRE(bench.wait([&] { return tipDepth(jointsOf(arm)) > 0.45; }));
            bench.unplug();
            atCut = bench.with([&] { return jointsOf(arm); });
            if (back) {
                std::this_thread::sleep_for(std::chrono::milliseconds(300));
                bench.plug();
            }
        });
        CHECK(driven.run.exitCode == (back ? 0 : 3));
        REQUIRE(!driven.arm.is_null());
        checkHeld(driven);
        CHECK(driven.turns("gone") > 100);
        CHECK(driven.arm.at("reopened").get<int>() == (back ? 1 : 0));
        CHECK((driven.arm.at("last_state") == "gone") == !back);
        CHECK(driven.run.err.find(": gone") != std::string::npos);
        const double went = bench.with([&] { return tipDepth(jointsOf(arm)); }) - tipDepth(atCut);
        CHECK((back ? went > 0.01 : std::abs(went) < 0.02));
    }
}

TEST_CASE("A motor that draws too much holds the arm until forces are turned off and on") {
    std::vector<HandRow> hand = pushing(6.0);
    hand[2].buttons = 2; // dead-man open for 0.5 s
    hand.insert(hand.begin() + 3, {3.3, {0, 0, 0.18}});
    const Stage stage;
    setUp(stage, kReach, hand);
    ReachSimulator arm;
    setStart(arm);
    ArmBench bench(arm, stage / "line");
    const Driven driven = drive(stage, [&] {
        REQUIRE(bench.wait([&] { return tipDepth(jointsOf(arm)) > 0.43; }));
        bench.with([&] { arm.current[4] = 2500.0; });
        std::this_thread::sleep_for(std::chrono::milliseconds(300));
        bench.with([&] { arm.current[4] = 100.0; });
    });
    REQUIRE_MESSAGE(driven.run.exitCode == 0, driven.run.err);
    checkHeld(driven);
    CHECK(driven.turns("overloaded") > 300);
    bool released = true;
    int resumed = 0;
    for (const auto& [t, state] : driven.states) { // latched: it never resumes by itself
        released = state == "overloaded" ? false : released || t > 2.7;
        CHECK((state != "follows" || released));
        resumed += t > 3.3 && state == "follows" ? 1 : 0;
    }
    CHECK(resumed > 100);
}
