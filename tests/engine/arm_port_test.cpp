// SPDX-License-Identifier: Apache-2.0
// A real arm that follows the scene's: reports in, setpoints out.
#include "tests/engine/arm_world.h"
#include "tests/haptics/allocation_count.h"

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <limits>

using namespace fathom;
using namespace fathom::testing;

namespace {

EngineOptions withArm() {
    EngineOptions options;
    options.measuredArm = true;
    return options;
}

MeasuredArm measured(double q, bool ready = true) {
    MeasuredArm arm;
    arm.posture.joints[0] = q;
    arm.stamp = now();
    arm.ready = ready;
    return arm;
}

// Steps and reports for a while: frames at 30 Hz, steps and reports at about 1 kHz. A perfect arm: it is
// where the last setpoint was.
struct Run {
    Run()
        : engine(folder.armScene(), smallCamera(), withArm())
        , camera(engine.camera())
        , arm(engine.openArm())
        , hand(engine.openHand(startAt(0.45))) {}

    // Until `done` says so for the newest step; false after 20 s.
    template <class Done>
    bool until(double z, bool reports, bool ready, Done done) {
        for (int i = 0; i < 20'000; ++i) {
            if (i % 33 == 0) {
                CHECK(camera.submit(wall.at(now())) == SubmitStatus::Accepted);
            }
            if (reports) {
                CHECK(arm.report(measured(q, ready)) == ReportStatus::Accepted);
            }
            step = hand.step(handAt(z), now());
            setpoint = arm.setpoint();
            if (reports && ready && !setpoint.hold) {
                q = setpoint.posture.joints[0];
            }
            if (done()) {
                return true;
            }
            std::this_thread::sleep_for(std::chrono::microseconds(700));
        }
        return false;
    }

    ArmFolder folder;
    Engine engine;
    CameraPort camera;
    ArmPort arm;
    HandPort hand;
    Wall wall;
    Step step;
    ArmSetpoint setpoint;
    double q = 0.15; // not where the scene's arm starts
};

} // namespace

TEST_CASE("Reports with unusable stamps or joints are rejected") {
    const ArmFolder folder;
    Engine engine(folder.armScene(), smallCamera(), withArm());
    ArmPort arm = engine.openArm();
    MeasuredArm report = measured(0.2);
    report.stamp = 0;
    CHECK(arm.report(report) == ReportStatus::MissingStamp);
    report.stamp = now() + 50'000'000;
    CHECK(arm.report(report) == ReportStatus::StampAhead);
    report.stamp = now();
    CHECK(arm.report(report) == ReportStatus::Accepted);
    CHECK(arm.report(report) == ReportStatus::StampBack);
    report = measured(std::nan(""));
    CHECK(arm.report(report) == ReportStatus::BadPosture);
    report = measured(0.2);
    report.posture.grasp = std::nan(""); // unknown
    CHECK(arm.report(report) == ReportStatus::Accepted);
    CHECK(arm.joints() == 1);
    CHECK(arm.jointName(0) == "slide");
    CHECK_THROWS_AS(arm.jointName(1), BadInput);
}

TEST_CASE("The arm's port opens once, and only where a real arm was announced") {
    const ArmFolder folder;
    Engine announced(folder.armScene(), smallCamera(), withArm());
    const ArmPort arm = announced.openArm();
    CHECK_THROWS_AS(announced.openArm(), Error);
    Engine unannounced(folder.armScene(), smallCamera());
    CHECK_THROWS_AS(unannounced.openArm(), BadInput);
    CHECK_THROWS_WITH_AS(Engine(wallScene(), smallCamera(), withArm()),
                         "options: measuredArm: true (allowed: false: the scene has no arm)", BadInput);
    CHECK_THROWS_AS(Lockstep(folder.armScene(), smallCamera(), startAt(0.5), withArm()), BadInput);
}

TEST_CASE("The tool starts where the arm was measured, leads it to the wall and stops with it") {
    Run run;
    // Silent: no force, no setpoint.
    CHECK(run.until(0.45, false, true, [&, i = 0]() mutable { return ++i > 300; }));
    CHECK(warns(run.step, StepWarning::ArmStill));
    CHECK(run.setpoint.hold);
    CHECK(run.step.arm.joints[0] == doctest::Approx(0.2));
    // The first reports place the tool.
    CHECK(run.until(0.45, true, true, [&] { return run.step.arm.joints[0] != 0.2 || !run.setpoint.hold; }));
    CHECK(run.step.arm.joints[0] == doctest::Approx(0.15));
    CHECK_FALSE(warns(run.step, StepWarning::ArmStill));
    // It follows the hand, which is 0.01 m in the wall at 0.56 + (0.45 - 0.45).
    CHECK(run.until(0.45, true, true, [&] { return !run.setpoint.hold; }));
    double z = 0.45;
    CHECK(run.until(z, true, true, [&] { return !run.setpoint.hold && run.step.state == State::Free; }));
    const double offset = 0.45 - (run.q + 0.3); // of the hand's map, which was aligned with the arm
    for (; z < 0.56 + offset; z += 0.001) {
        CHECK(run.until(z, true, true, [&, i = 0]() mutable { return ++i > 3; }));
    }
    CHECK(run.until(z, true, true, [&, i = 0]() mutable { return ++i > 200; }));
    CHECK(run.step.state == State::Contact);
    CHECK(run.q == doctest::Approx(0.25).epsilon(0.005)); // the ball rests at z = 0.55 m
    CHECK(run.step.wrench.force[2] < -5.0);
    // A fault: no force, and the arm is commanded to stop.
    CHECK(run.until(z, true, false, [&] { return run.step.wrench.force[2] == 0.0; }));
    CHECK(warns(run.step, StepWarning::ArmStill));
    CHECK(run.setpoint.hold);
}

TEST_CASE(
    "Setpoints hold when steps stop and when the hand is gone, and report and setpoint never allocate") {
    const ArmFolder folder;
    Engine engine(folder.armScene(), smallCamera(), withArm());
    ArmPort arm = engine.openArm();
    CHECK(arm.setpoint().hold);
    CHECK(arm.setpoint().stamp == 0);
    {
        HandPort hand = engine.openHand(startAt(0.5));
        hand.step(handAt(0.5), now());
        const ArmSetpoint setpoint = arm.setpoint();
        CHECK(std::abs(now() - setpoint.stamp) < 1'000'000'000);
    }
    CHECK(arm.setpoint().hold);
    const MeasuredArm report = measured(0.2);
    const uint64_t before = threadAllocationCount();
    const ReportStatus status = arm.report(report);
    const ArmSetpoint setpoint = arm.setpoint();
    CHECK(threadAllocationCount() == before);
    CHECK(status == ReportStatus::Accepted);
    CHECK(setpoint.hold);
}

TEST_CASE("An arm that does not know its grasp never sees its own fingers as a region") {
    const ArmFolder folder;
    for (const double grasp : {std::nan(""), -std::numeric_limits<double>::infinity(), 0.0}) {
        Engine engine(folder.fingerScene(), smallCamera(), withArm());
        CameraPort camera = engine.camera();
        ArmPort arm = engine.openArm();
        ObserverPort observer = engine.openObserver();
        Wall nothing;
        std::ranges::fill(nothing.depth, std::uint16_t{0});
        for (const size_t row : {29, 30, 31}) { // the finger at grasp 0: 0.536 m before the camera
            std::fill_n(nothing.depth.begin() + static_cast<std::ptrdiff_t>(row * 80 + 39), 3,
                        std::uint16_t{536});
        }
        MeasuredArm report = measured(0.2);
        report.posture.grasp = grasp;
        CHECK(arm.report(report) == ReportStatus::Accepted);
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
        CHECK(camera.submit(nothing.at(now())) == SubmitStatus::Accepted);
        Regions regions;
        CHECK(eventually([&] { return observer.regions(regions); }));
        CHECK(regions.spheres.empty());
    }
}
