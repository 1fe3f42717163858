// SPDX-License-Identifier: Apache-2.0
// Scenes of placed shapes only, which need no compute device and no frames.
#include "tests/engine/wall_world.h"

#include <doctest/doctest.h>
#include <limits>

using namespace fathom;
using namespace fathom::testing;

namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

} // namespace

TEST_CASE("A scene of placed shapes pushes in full without frames, and no warning says that one is missing") {
    Engine engine(boxScene(), smallCamera());
    HandPort hand = engine.openHand(startAt(0.5));
    CHECK(engine.computeDeviceName() == "none");
    Step step;
    for (double z = 0.5; z < 0.55; z += 0.0005) {
        step = hand.step(handAt(z), now());
    }
    CHECK(step.state == State::Contact);
    CHECK(step.wrench.force[2] < -9.0);
    CHECK(step.warnings == StepWarning::None);
    CHECK(step.clearance == kInfinite);
    Lockstep offline(boxScene(), smallCamera(), startAt(0.5));
    CHECK_FALSE(warns(offline.step(handAt(0.5), 1'000'000), StepWarning::NoScene));
}

TEST_CASE("A device named for a scene of placed shapes alone has a warning, for it is not used") {
    std::string lines;
    setLogCallback([&](LogLevel level, std::string_view line) {
        lines += level == LogLevel::Warning ? std::string(line) + "\n" : "";
    });
    EngineOptions options;
    { const Engine engine(boxScene(), smallCamera(), options); }
    CHECK(lines.empty());
    options.computeDevice = "nosuch";
    { const Engine engine(boxScene(), smallCamera(), options); }
    const std::string warning = "device 'nosuch' is not used: no fixture uses points\n";
    CHECK(lines == warning);
    const Lockstep lockstep(boxScene(), smallCamera(), startAt(0.5), options);
    CHECK(lines == warning + warning);
    setLogCallback(nullptr);
}
