// SPDX-License-Identifier: Apache-2.0
// Batches of poses through the public interface.
#include "tests/engine/wall_world.h"

#include <cmath>
#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::testing;

namespace {

std::vector<Pose> rowOfPoses() {
    std::vector<Pose> poses;
    for (const double z : {0.1, 0.3, 0.55, 0.6, 5.0}) {
        poses.push_back({{0.02, -0.01, z}, {2.0, 0.0, 0.0, 0.0}}); // normalised by the library
    }
    return poses;
}

double gapOf(const Clearance& c, const Pose& pose) {
    double d2 = 0.0; // the wall's tool is at its origin, so its rotation does not matter
    for (size_t k = 0; k < 3; ++k) {
        const double d = pose.position[k] + c.toolCentre[k] - c.regionCentre[k];
        d2 += d * d;
    }
    return std::sqrt(d2) - c.toolRadius - c.regionRadius;
}

} // namespace

TEST_CASE("Clearances name the pair that has the gap, and there are none before the first frame") {
    Lockstep lockstep(wallScene(), smallCamera(), startAt(0.3));
    const std::vector<Pose> poses = rowOfPoses();
    Clearances out;
    lockstep.clearances(poses, out);
    CHECK(out.frame == -1);
    CHECK(out.poses.empty());
    const Wall wall;
    lockstep.process(wall.at(5'000'000'000));
    lockstep.clearances(poses, out);
    CHECK(out.frame == 0);
    CHECK(std::abs(out.stamp - 5'000'000'000) <= 1000);
    REQUIRE(out.poses.size() == poses.size());
    for (size_t i = 0; i < poses.size(); ++i) {
        const Clearance& c = out.poses[i];
        CHECK(c.gap == doctest::Approx(gapOf(c, poses[i])).epsilon(1e-9));
        CHECK(std::abs(c.gap - (std::abs(0.6 - poses[i].position[2]) - 0.05)) <
              4e-3); // pixels are 9 mm apart
        CHECK(c.toolRadius == doctest::Approx(0.01));
        CHECK(c.regionRadius == doctest::Approx(0.04).epsilon(0.01));
        CHECK(c.fixture == 0);
    }
    const double last = out.poses[3].gap;
    std::vector<Pose> broken = poses; // these have no clearance, and the others keep theirs
    broken[1].position[0] = std::nan("");
    broken[2].rotation = {0.0, 0.0, 0.0, 0.0};
    lockstep.clearances(broken, out);
    CHECK(std::isnan(out.poses[1].gap));
    CHECK(std::isnan(out.poses[2].gap));
    CHECK(out.poses[3].gap == last);
    lockstep.clearances({}, out);
    CHECK(out.frame == 0);
    CHECK(out.poses.empty());
}

TEST_CASE("A step reports the clearance beyond the reach, and an engine's batch equals that of lockstep") {
    Lockstep lockstep(wallScene(), smallCamera(), startAt(0.2));
    const Wall wall;
    lockstep.process(wall.at(1'000'000'000));
    CHECK(std::isnan(lockstep.step(handAt(0.2), 1'000'000'000).clearance));
    REQUIRE(lockstep.queryContacts());
    CHECK(std::abs(lockstep.step(handAt(0.2), 1'001'000'000).clearance - 0.35) < 2e-3);
    Clearances offline, live;
    lockstep.clearances(rowOfPoses(), offline);

    Engine engine(wallScene(), smallCamera());
    CameraPort camera = engine.camera();
    HandPort hand = engine.openHand(startAt(0.2));
    CHECK(camera.submit(wall.at(now())) == SubmitStatus::Accepted);
    REQUIRE(eventually([&] {
        engine.clearances(rowOfPoses(), live);
        return live.frame >= 0;
    }));
    for (size_t i = 0; i < live.poses.size(); ++i) {
        CHECK(live.poses[i].gap == offline.poses[i].gap);
    }
    CHECK(eventually([&] { return std::abs(hand.step(handAt(0.2), now()).clearance - 0.35) < 2e-3; }));
}
