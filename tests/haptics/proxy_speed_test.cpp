// SPDX-License-Identifier: Apache-2.0
// Time of a haptic step at the size of the budget: printed, never asserted.
#include "tests/haptics/proxy_rig.h"
#include "tests/support/sanitized.h"

#include <algorithm>
#include <chrono>
#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::testing;

TEST_CASE("The step time of 256 leaves in contact with 60 k spheres is printed") {
    std::mt19937_64 random(21);
    Fixtures fixtures = emptySet();
    std::normal_distribution<double> noise(0.0, 0.0003);
    addWall(fixtures, dvec3(0.0), dvec3(1, 0, 0), dvec3(0, 1, 0), 0.2144, 0.00175, 0.04);
    for (float& z : fixtures.spheres.z) { // a bulging, noisy surface
        const size_t i = static_cast<size_t>(&z - fixtures.spheres.z.data());
        const double x = fixtures.spheres.x[i], y = fixtures.spheres.y[i];
        z = static_cast<float>(0.01 * std::sin(20.0 * x) * std::cos(17.0 * y) + noise(random));
    }
    const Tool tool = randomTool(random, 256, 0.06, 0.008);
    for (const double speed : {0.05, 0.3, 2.0}) {
        ProxyRig rig(tool, fixtures, {dvec3(0, 0, 0.16), kUpright});
        std::vector<double> times;
        uint64_t solves = 0, rounds = 0, bisected = 0, contact = 0;
        Pose hand = rig.proxy().pose();
        for (int k = 0; k < (kSanitized ? 400 : 3000); ++k) {
            // Presses the tool 2 mm in and drags it around.
            const double a = speed / 0.08 * 0.001 * k;
            hand.position = dvec3(0.08 * std::cos(a), 0.08 * std::sin(a), k < 200 ? 0.16 - 0.001 * k : 0.0);
            hand.position.z = std::max(hand.position.z, rig.proxy().pose().position.z - 0.002);
            hand.rotation = rotationExp(dvec3(0.3 * std::sin(a), 0.3 * std::cos(1.3 * a), 0.0));
            rig.query();
            const auto start = std::chrono::steady_clock::now();
            const ProxyStep tick = rig.turnOnly(hand);
            const std::chrono::duration<double, std::micro> took = std::chrono::steady_clock::now() - start;
            if (k >= 300) {
                times.push_back(took.count());
                solves += tick.solves, rounds += tick.rounds, bisected += tick.bisected;
                contact += tick.contact ? 1 : 0;
            }
            REQUIRE(tick.minGap >= 0.0);
        }
        std::sort(times.begin(), times.end());
        MESSAGE(speed << " m/s, " << rig.inForce().pairSphere.size() << " pairs: step p50 "
                      << times[times.size() / 2] << " p99 " << times[times.size() * 99 / 100]
                      << " us; solves " << solves << " rounds " << rounds << " bisected " << bisected
                      << " in contact " << contact << " of " << times.size());
        CHECK(contact > times.size() / 2);
    }
}
