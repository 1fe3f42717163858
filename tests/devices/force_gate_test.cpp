// SPDX-License-Identifier: Apache-2.0
#include "devices/bridge/force_gate.h"

#include <doctest/doctest.h>
#include <limits>

using namespace fathom;

namespace {

constexpr uint64_t kMs = 1000000;

} // namespace

TEST_CASE("The force gate starts closed, passes wrenches, and closes after 10 ms of silence") {
    ForceGate gate(8.0, 0.2);
    const uint64_t t = 5000 * kMs;
    CHECK(gate.at(t).force.x == 0.0);
    gate.accept({{3.0, 0.0, 0.0}, {0.0, 0.1, 0.0}}, t);
    CHECK(gate.at(t).force.x == 0.0); // it rises
    for (uint64_t ms = 1; ms <= 200; ++ms) {
        gate.accept({{3.0, 0.0, 0.0}, {0.0, 0.1, 0.0}}, t + ms * kMs);
    }
    CHECK(gate.at(t + 200 * kMs).force.x == 3.0);
    CHECK(gate.at(t + 200 * kMs).torque.y == 0.1);
    CHECK(gate.at(t + 210 * kMs).force.x == 3.0);
    CHECK(gate.at(t + 210 * kMs + 1).force.x == 0.0);
    CHECK(gate.at(t + 210 * kMs + 1).torque.y == 0.0);

    gate.accept({{3.0, 0.0, 0.0}, {}}, t + 300 * kMs);
    CHECK(gate.silences() == 1);
    gate.accept({{3.0, 0.0, 0.0}, {}}, t + 309 * kMs);
    CHECK(gate.at(t + 310 * kMs).force.x == doctest::Approx(0.8)); // a tenth of the limit
    gate.close();
    CHECK(gate.at(t + 310 * kMs).force.x == 0.0);
}

TEST_CASE("The force gate scales to the limits without a change of direction and closes on values that are "
          "not finite") {
    ForceGate gate(5.0, 0.2);
    gate.accept({{30.0, 40.0, 0.0}, {0.0, 0.0, 2.0}}, kMs);
    for (uint64_t ms = 2; ms < 150; ++ms) {
        gate.accept({{30.0, 40.0, 0.0}, {0.0, 0.0, 2.0}}, ms * kMs);
    }
    const Wrench wrench = gate.at(149 * kMs);
    CHECK(wrench.force.x == doctest::Approx(3.0));
    CHECK(wrench.force.y == doctest::Approx(4.0));
    CHECK(wrench.torque.z == doctest::Approx(0.2));
    gate.accept({{std::numeric_limits<double>::quiet_NaN(), 0.0, 0.0}, {}}, 150 * kMs);
    CHECK(gate.at(150 * kMs).force.y == 0.0);
    CHECK(gate.notFinite() == 1);
}

TEST_CASE("A wrench that is older than the one before changes nothing") {
    ForceGate gate(8.0, 0.2);
    for (uint64_t ms = 1; ms <= 200; ++ms) {
        gate.accept({{3.0, 0.0, 0.0}, {}}, ms * kMs);
    }
    gate.accept({{7.0, 0.0, 0.0}, {}}, 198 * kMs);
    CHECK(gate.at(205 * kMs).force.x == 3.0);
    gate.accept({{7.0, 0.0, 0.0}, {}}, 200 * kMs);
    CHECK(gate.at(205 * kMs).force.x == 7.0);
}
