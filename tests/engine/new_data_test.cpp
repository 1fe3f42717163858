// SPDX-License-Identifier: Apache-2.0
// A frame that shows something else than the one before, with a hand that rests in front of a wall.
#include "tests/engine/wall_world.h"

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <string>

using namespace fathom;
using namespace fathom::testing;

namespace {

struct Motion {
    double speed = 0.0;    // [m/s] fastest tick
    double farthest = 0.0; // [m] from the start
    double force = 0.0;    // [N]
    bool escaped = false;
};

// One second with the wall, then a quarter with the second image, then with the wall again. The hand rests at
// 0.45 m.
Motion motionWith(const Wall& second, int rate) {
    Scene scene = Scene::fromText(R"(
camera: { near: 0.1, far: 3.0 }
fixtures: [{ name: wall, role: forbidden, radius: 0.04 }]
tool: { spheres: [[0, 0, 0, 0.01]] }
haptics: { rate_hz: )" + std::to_string(rate) +
                                  " }\n");
    Lockstep lockstep(scene, smallCamera(), startAt(0.45));
    Motion motion;
    double last = 0.45;
    for (int i = 1; i < 2 * rate; ++i) {
        const Nanoseconds t = 1'000'000'000ll / rate * i;
        if (i % (rate / 40) == 1) {
            lockstep.process((i >= rate && i < rate * 5 / 4 ? second : Wall()).at(t));
        }
        lockstep.queryContacts();
        const Step step = lockstep.step(handAt(0.45), t);
        const double z = step.baseTtool.position[2];
        motion.speed = std::max(motion.speed, std::abs(z - last) * rate);
        motion.farthest = std::max(motion.farthest, std::abs(z - 0.45));
        motion.force = std::max(motion.force, std::abs(step.wrench.force[2]));
        motion.escaped = motion.escaped || step.state == State::Escape;
        last = z;
    }
    return motion;
}

} // namespace

TEST_CASE("What passes between camera and tool, far from the tool, moves nothing and makes no force") {
    for (const int half : {0, 2, 30}) { // one pixel, whose point is rejected; 9 and 100 mm wide
        CAPTURE(half);
        Wall fish;
        for (int v = 30 - half; v <= std::min(59, 30 + half); ++v) {
            for (int u = 40 - half; u <= 40 + half; ++u) {
                fish.depth[static_cast<size_t>(v * 80 + u)] = 250;
            }
        }
        const Motion motion = motionWith(fish, 1000);
        CHECK(motion.farthest == 0.0);
        CHECK(motion.force == 0.0);
        CHECK_FALSE(motion.escaped);
    }
}

TEST_CASE("At every tick rate a tool leaves a region that new data puts over it at 1 to 2 m/s") {
    Wall near;
    std::ranges::fill(near.depth, std::uint16_t{470});
    for (const int rate : {500, 1000, 4000}) {
        CAPTURE(rate);
        const Motion motion = motionWith(near, rate);
        CHECK(motion.escaped);
        CHECK(motion.farthest == doctest::Approx(0.03).epsilon(0.1));
        CHECK(motion.speed < 2.0);
        CHECK(motion.speed > 0.9);
    }
}
