// SPDX-License-Identifier: Apache-2.0
// Ports that outlive their engine.
#include "tests/engine/wall_world.h"

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <memory>

using namespace fathom;
using namespace fathom::testing;

TEST_CASE("Forces fade once the engine is gone, as without frames") {
    auto engine = std::make_unique<Engine>(wallScene(), smallCamera());
    CameraPort port = engine->camera();
    HandPort hand = engine->openHand(startAt(0.5));
    const Wall wall;
    double z = 0.5;
    const auto force = [&] { return std::abs(hand.step(handAt(z), now()).wrench.force[2]); };
    REQUIRE(eventually([&] {
        CHECK(port.submit(wall.at(now())) == SubmitStatus::Accepted);
        z = std::min(0.56, z + 0.0005);
        return force() > 5.0;
    }));
    engine.reset();
    CHECK(eventually([&] { return force() == 0.0; }));
    CHECK(hand.step(handAt(z), now()).sceneAge > 0.1);
}

TEST_CASE("The force of a placed shape, which needs no frames, fades once the engine is gone") {
    auto engine = std::make_unique<Engine>(boxScene(), smallCamera());
    HandPort hand = engine->openHand(startAt(0.5));
    double z = 0.5;
    Step step;
    const auto force = [&] {
        step = hand.step(handAt(z = std::min(0.55, z + 0.0005)), now());
        return std::abs(step.wrench.force[2]);
    };
    REQUIRE(eventually([&] { return force() > 5.0; }));
    engine.reset();
    CHECK(eventually([&] { return force() == 0.0; }));
    CHECK(step.state == State::Off);
    CHECK(warns(step, StepWarning::EngineFailed));
    CHECK(step.baseTtool.position[2] < 0.5401); // still not in the box
}
