// SPDX-License-Identifier: Apache-2.0
// The controller's damping fades with the force, and ends without a region.
#include "engine/haptics/passivity.h"

#include <doctest/doctest.h>

using namespace fathom;

namespace {

constexpr double kDevice = 0.5; // [N s/m] of the device

// A controller that owes 27.5 mJ: the tool moved by 5 mm against a hand that pressed by 3 mm.
struct Owing {
    PassivityController controller{PassivityOptions{kDevice, kDevice * 4e-4, 0.02, 0}};
    PassivityStep tick;

    explicit Owing(double fadeGain = 1.0) {
        tick.springs.stiffness = 1000.0;
        tick.springs.rotationalStiffness = 0.4;
        tick.springs.metricRadius = 0.02;
        tick.fadeGain = fadeGain;
        tick.contact.force = {0, 0, 3};
        step(dvec3(0.0));
        tick.contact.force = {0, 0, 8};
        step(dvec3(0.0));
    }
    Wrench step(const dvec3& moved) {
        tick.device.position += moved;
        tick.springEnd.position += moved;
        const Wrench damper = controller.step(tick);
        controller.delivered({tick.fadeGain * tick.contact.force, tick.fadeGain * tick.contact.torque},
                             damper);
        return damper;
    }
    // The spring pushes the hand out, undamped, and the region is gone.
    void leave() {
        for (int i = 0; i < 8; ++i) {
            tick.device.position.z += 0.001;
            tick.springEnd.position.z += 0.001;
            tick.contact.force.z -= 1.0;
            controller.step(tick);
            controller.delivered(tick.contact, {});
        }
        tick.contact = {};
        tick.rows = false;
    }
};

} // namespace

TEST_CASE("The damping falls by the factor by which forces fade") {
    const dvec3 inwards(0, 0, -1e-5); // slow enough for the cap of the damping
    const double whole = glm::length(Owing().step(inwards).force);
    CHECK(whole == doctest::Approx(PassivityController::kMaxDamping * kDevice * 0.01));
    CHECK(glm::length(Owing(0.5).step(inwards).force) == doctest::Approx(0.5 * whole));
}

TEST_CASE("Without an active row the damping ends without a click") {
    Owing owing;
    owing.leave();
    double before = glm::length(owing.step({0, 1e-5, 0}).force);
    CHECK(before > 0.15); // at 0.01 m/s, 20 N s/m
    for (int i = 0; i < 100; ++i) {
        const double force = glm::length(owing.step({0, 5e-5, 0}).force);
        CHECK(before - force < 0.04);
        before = force;
    }
    CHECK(before == 0.0);
}

TEST_CASE("Without an active row the damping is below 1 N, and the debt is given up after 90 ms") {
    Owing fast;
    fast.leave();
    CHECK(glm::length(fast.step({0, 5e-4, 0}).force) ==
          doctest::Approx(PassivityController::kFreeDamper)); // at 0.5 m/s
    Owing slow;
    slow.leave();
    for (int i = 0; i < 89; ++i) {
        slow.step({0, 2e-7, 0});
    }
    CHECK(slow.controller.debt() > 0.01);
    slow.step({0, 2e-7, 0});
    slow.step({0, 2e-7, 0});
    CHECK(slow.controller.debt() <= 0.0);
    CHECK(glm::length(slow.step({0, 5e-4, 0}).force) == 0.0);
}
