// SPDX-License-Identifier: Apache-2.0
// The closed loop of a real arm with simulated motors: pilot -> proxy in joint space -> serial line -> arm ->
// joints
// -> spheres of every link.
#include "devices/serial/reach_arm.h"
#include "tests/devices/pty_line.h"
#include "tests/haptics/arm_proxy_world.h"

#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::testing;

namespace {

constexpr double kTurn = 0.001; // [s]
constexpr int kTurnsAStep = 10; // steps of the line per tick

// Places the arm at its measured joints.
ArmFrames measured(const ArmModel& model, const ArmFeedback& feedback) {
    JointVector q{};
    for (size_t k = 0; k < model.count(); ++k) {
        q[k] = feedback.position[k];
    }
    ArmFrames frames;
    model.place(q, Pose{}, frames);
    return frames;
}

struct Loop {
    ArmModel model = makeArm(4, 8);
    ArmProxy proxy{model, Pose{}, {}, JointVector{}};
    World world;
    ReachSimulator arm;
    PtyLine line{arm};
    SerialPort port{line.name(), 115200};
    ReachArm driver{port};
    int stale = 0; // steps without fresh feedback, after the first 0.1 s
    double now = 0.0, deepestProxy = -1.0, deepestArm = -1.0, lag = 0.0;

    void run(double seconds, const Pose& target, bool hold = false) {
        for (double end = now + seconds; now < end; now += kTurn * kTurnsAStep) {
            for (int i = 0; i < kTurnsAStep; ++i) {
                world.query(model, proxy);
                proxy.step(target, 0.0, &world.set);
                deepestProxy = std::max(deepestProxy, world.depth(model, proxy.frames()));
            }
            ArmCommand command;
            command.hold = hold;
            std::copy_n(proxy.joints().begin(), model.count(), command.position.begin());
            driver.step(now, command);
            line.exchange(now);
            arm.step(kTurn * kTurnsAStep);
            stale += now > 0.1 && driver.feedback().stale ? 1 : 0;
            const ArmFrames frames = measured(model, driver.feedback());
            deepestArm = std::max(deepestArm, world.depth(model, frames));
            lag = std::max(lag, glm::distance(model.tip(frames).position, proxy.tip().position));
        }
    }
};

} // namespace

TEST_CASE("The loop of pilot, proxy, joints, serial line and arm keeps every link off a region") {
    for (const LineFaults& faults : {LineFaults{}, LineFaults{0.002, 0.002, true, 0.02, false}}) {
        Loop loop;
        loop.world.fixtures.spheres.add({0.12, 0.2, 0.0}, 0.05); // next to the first link
        loop.world.grid.build(loop.world.fixtures.spheres);
        loop.line.faults = faults;
        loop.run(3.0, {{0.1, 0.95, 0.0}, kUpright}); // the region stops the elbow on the way
        const ArmFrames rest = measured(loop.model, loop.driver.feedback());
        const double resting = loop.world.depth(loop.model, rest);
        MESSAGE("noise " << faults.noise << ": proxy " << loop.deepestProxy * 1e6
                         << " um deep, arm on the way " << loop.deepestArm * 1e3 << " mm, at rest "
                         << resting * 1e6 << " um; lag up to " << loop.lag * 1e3 << " mm");
        CHECK((loop.stale == 0 || faults.noise > 0.0)); // feedback is fresh also while it rests on the region
        CHECK(loop.deepestProxy <= 1e-9);
        CHECK(loop.deepestArm < 2e-3); // the arm's lag bends its path; the margin of a region covers that
        CHECK(resting < 2e-5);
        CHECK(resting > -1e-3); // it rests on the region
        CHECK(glm::distance(loop.model.tip(rest).position, loop.proxy.tip().position) < 1e-4);

        const auto before = loop.arm.position;
        loop.run(0.5, {{0.9, 0.0, 0.0}, kUpright}, true);
        for (size_t d = 1; d < before.size(); ++d) {
            CHECK(std::abs(loop.arm.position[d] - before[d]) < 1e-3); // the arm holds
        }
    }
}
