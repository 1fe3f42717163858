// SPDX-License-Identifier: Apache-2.0
// A localisation that starts at another place: only the first pose of the camera is wrong.
#include "tests/engine/wall_world.h"

#include <algorithm>
#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::testing;

TEST_CASE("A wrong first pose of the camera, however far away, costs later frames no protection") {
    for (const double away : {0.0, 999.0, 1001.0, 1e6}) {
        CAPTURE(away);
        HandStart start = startAt(0.5);
        start.deviceThandle.position[0] = 0.1;
        Lockstep lockstep(wallScene(), smallCamera(), start);
        const Wall wall;
        Frame wrong = wall.at(1);
        wrong.baseTcamera.position[0] = away;
        lockstep.process(wrong);
        Hand hand{start.deviceThandle};
        Step step;
        double deepest = 0.0;
        for (int i = 1; i < 500; ++i) {
            const Nanoseconds t = 1'000'000 * static_cast<Nanoseconds>(i);
            if (i % 33 == 1) {
                lockstep.process(wall.at(t));
            }
            lockstep.queryContacts();
            hand.deviceThandle.position[2] = std::min(0.57, hand.deviceThandle.position[2] + 0.0002);
            step = lockstep.step(hand, t);
            deepest = std::max(deepest, step.baseTtool.position[2]);
        }
        CHECK(deepest < 0.55 + 1e-5);
        CHECK(step.wrench.force[2] < -15.0);
    }
}

TEST_CASE("A pose of the camera more than 1000 km away is rejected") {
    Frame frame = Wall().at(now());
    frame.baseTcamera.position[1] = -1.1e6;
    Engine engine(wallScene(), smallCamera());
    CHECK(engine.camera().submit(frame) == SubmitStatus::BadPose);
    Lockstep lockstep(wallScene(), smallCamera(), startAt(0.5));
    CHECK_THROWS_AS(lockstep.process(frame), BadInput);
}
