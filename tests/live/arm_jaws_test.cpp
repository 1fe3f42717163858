// SPDX-License-Identifier: Apache-2.0
// The jaws of an arm on a serial line, closed and opened by a button of the hand.
#include "tests/rig/arm_stage.h"

#include <chrono>
#include <doctest/doctest.h>
#include <future>

using namespace fathom;
using namespace fathom::testing;

namespace {

using Clock = std::chrono::steady_clock;

constexpr double kOpen = 18.0, kClosed = 2.0; // [mm]

// The hand stays still; its button is down from 0.5 s to 3 s.
void setUpJaws(const Stage& stage) {
    setUp(stage, std::string(kReach) + ", jaws: {open: 0.018, closed: 0.002}",
          {{0.0, {0, 0, 0}}, {0.5, {0, 0, 0}, {1, 0, 0, 0}, 8}, {3.0, {0, 0, 0}}, {5.0, {0, 0, 0}}});
    stage.write("scene.yaml", stage.read("scene.yaml") + "  grasp: {fingers: [{joint: pinch, open: 0.5, "
                                                         "closed: 0}], button: 8, seconds: 1}\n");
    std::string model = urdf();
    model.insert(model.find("</robot>"),
                 "<link name='jaw'><collision><geometry><sphere radius='0.01'/></geometry></collision></link>"
                 "<joint name='pinch' type='revolute'><parent link='three'/><child link='jaw'/><origin "
                 "xyz='0.2 0 0'/><axis xyz='0 0 1'/><limit effort='1' velocity='0.4' lower='0' upper='0.5'/>"
                 "</joint>");
    stage.write("arm.urdf", model);
}

ReachSimulator openArm() {
    ReachSimulator arm;
    setStart(arm);
    arm.position[1] = kOpen;
    return arm;
}

// Runs the program with an arm whose jaws are open at first.
struct JawsAtWork {
    JawsAtWork() {
        setUpJaws(stage);
        running = std::async(std::launch::async, [this] {
            return runFathom(stage.command({"--realtime", "--arm", (stage / "line").string()}));
        });
    }

    Stage stage;
    ReachSimulator arm = openArm();
    ArmBench bench{arm, stage / "line"};
    std::future<ProgramRun> running;
};

} // namespace

TEST_CASE("A button of the hand closes the jaws at the speed of the scene, and its release opens them") {
    JawsAtWork work;
    ArmBench& bench = work.bench;
    ReachSimulator& arm = work.arm;
    REQUIRE(bench.wait([&] { return arm.position[1] < kOpen - 1.0; }));
    const auto begun = Clock::now();
    REQUIRE(bench.wait([&] { return arm.position[1] < kClosed + 1.0; }));
    CHECK(std::chrono::duration<double>(Clock::now() - begun).count() > 0.6); // 14 of 16 mm, 1 s in all
    REQUIRE(bench.wait([&] { return arm.position[1] > kOpen - 0.5; }));
    const ProgramRun run = work.running.get();
    REQUIRE_MESSAGE(run.exitCode == 0, run.err);
    const auto q = bench.with([&] { return jointsOf(arm); });
    for (size_t j = 0; j < 3; ++j) { // the other joints stay
        CHECK(std::abs(q[j] - kStart[j]) < 0.01);
    }
}

TEST_CASE("When the jaws close on an object, the whole arm holds and the log reports an overload") {
    JawsAtWork work;
    ArmBench& bench = work.bench;
    ReachSimulator& arm = work.arm;
    REQUIRE(bench.wait([&] { return arm.position[1] < 10.0; }));
    bench.with([&] { arm.current[1] = 2500.0; }); // [mA]
    const ProgramRun run = work.running.get();
    REQUIRE_MESSAGE(run.exitCode == 0, run.err);
    CHECK(run.out.find("overloaded") != std::string::npos);
    CHECK(bench.with([&] { return arm.position[1]; }) > kClosed + 0.5);
    const auto summary = nlohmann::json::parse(work.stage.read("out/summary.json"));
    CHECK(summary.at("arm").at("driven").at("turns").at("overloaded").get<uint64_t>() > 300);
}
