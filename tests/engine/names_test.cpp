// SPDX-License-Identifier: Apache-2.0
// Names for messages: of enumerators, of fixtures and of the compute device.
#include "tests/engine/wall_world.h"

#include <doctest/doctest.h>
#include <string>

using namespace fathom;
using namespace fathom::testing;

TEST_CASE("States, warnings and statuses have the names of their enumerators, other values none") {
    CHECK(name(State::Off) == std::string("Off"));
    CHECK(name(State::Contact) == std::string("Contact"));
    CHECK(name(State::Waiting) == std::string("Waiting"));
    CHECK(name(static_cast<State>(-1)) == std::string("unknown"));
    CHECK(name(StepWarning::None) == std::string("None"));
    CHECK(name(StepWarning::NoScene) == std::string("NoScene"));
    CHECK(name(StepWarning::OldScene | StepWarning::OtherClock) == std::string("OldScene"));
    CHECK(name(StepWarning::Stalled) == std::string("Stalled"));
    CHECK(name(StepWarning::OtherClock) == std::string("OtherClock"));
    CHECK(name(static_cast<StepWarning>(1u << 31)) == std::string("unknown"));
    CHECK(name(SubmitStatus::Accepted) == std::string("Accepted"));
    CHECK(name(SubmitStatus::MissingImage) == std::string("MissingImage"));
    CHECK(name(SubmitStatus::Closed) == std::string("Closed"));
    CHECK(name(ReportStatus::Accepted) == std::string("Accepted"));
    CHECK(name(ReportStatus::BadPosture) == std::string("BadPosture"));
    CHECK(name(static_cast<ReportStatus>(5)) == std::string("unknown"));
}

TEST_CASE("A scene names the fixture of each index, and no compute device runs for placed shapes alone") {
    const Scene scene =
        Scene::fromText("fixtures:\n"
                        "  - {name: box, role: forbidden, shape: box, size: [0.1, 0.1, 0.1]}\n"
                        "  - {name: floor, role: forbidden, shape: plane}\n"
                        "tool: {spheres: [[0, 0, 0.5, 0.01]]}\n");
    CHECK(scene.fixtures() == 2);
    CHECK(scene.fixtureName(0) == "box");
    CHECK(scene.fixtureName(1) == "floor");
    CHECK_THROWS_WITH_AS(scene.fixtureName(2), "fixture 2 (allowed: below 2)", BadInput);
    CHECK(Engine(scene, smallCamera()).computeDeviceName() == "none");
}
