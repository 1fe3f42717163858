// SPDX-License-Identifier: Apache-2.0
// Names for messages: of enumerators, of fixtures and of the compute device.
#include "tests/engine/wall_world.h"

#include <algorithm>
#include <doctest/doctest.h>
#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

using namespace fathom;
using namespace fathom::testing;

namespace {

// Checks the names of a whole enumeration, in the order of its values.
template <class Enumeration>
void checkNames(std::initializer_list<std::pair<Enumeration, const char*>> enumerators) {
    for (const std::pair<Enumeration, const char*>& one : enumerators) {
        CHECK(name(one.first) == std::string(one.second));
    }
}

} // namespace

TEST_CASE("States, warnings and statuses have the names of their enumerators, other values none") {
    checkNames<State>({{State::Off, "Off"},
                       {State::Free, "Free"},
                       {State::Contact, "Contact"},
                       {State::Escape, "Escape"},
                       {State::Trapped, "Trapped"},
                       {State::Fading, "Fading"},
                       {State::Waiting, "Waiting"},
                       {static_cast<State>(7), "unknown"},
                       {static_cast<State>(-1), "unknown"}});
    checkNames<StepWarning>({{StepWarning::None, "None"},
                             {StepWarning::NoScene, "NoScene"},
                             {StepWarning::OldScene, "OldScene"},
                             {StepWarning::ComputeDeviceLost, "ComputeDeviceLost"},
                             {StepWarning::NotFinite, "NotFinite"},
                             {StepWarning::TimeBack, "TimeBack"},
                             {StepWarning::Stalled, "Stalled"},
                             {StepWarning::EngineFailed, "EngineFailed"},
                             {StepWarning::ArmStill, "ArmStill"},
                             {StepWarning::OtherClock, "OtherClock"},
                             {StepWarning::OldScene | StepWarning::OtherClock, "OldScene"},
                             {static_cast<StepWarning>(512), "unknown"},
                             {static_cast<StepWarning>(1u << 31), "unknown"}});
    checkNames<SubmitStatus>({{SubmitStatus::Accepted, "Accepted"},
                              {SubmitStatus::MissingStamp, "MissingStamp"},
                              {SubmitStatus::StampAhead, "StampAhead"},
                              {SubmitStatus::StampBack, "StampBack"},
                              {SubmitStatus::MissingImage, "MissingImage"},
                              {SubmitStatus::BadPose, "BadPose"},
                              {SubmitStatus::Closed, "Closed"},
                              {static_cast<SubmitStatus>(7), "unknown"}});
    checkNames<ReportStatus>({{ReportStatus::Accepted, "Accepted"},
                              {ReportStatus::MissingStamp, "MissingStamp"},
                              {ReportStatus::StampAhead, "StampAhead"},
                              {ReportStatus::StampBack, "StampBack"},
                              {ReportStatus::BadPosture, "BadPosture"},
                              {static_cast<ReportStatus>(5), "unknown"}});
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

TEST_CASE("A surface that new frames show in front of the tool pushes without being a fixture of the scene") {
    Lockstep lockstep(wallScene(), smallCamera(), startAt(0.5));
    Wall wall;
    lockstep.process(wall.at(1'000'000));
    lockstep.queryContacts();
    lockstep.step(handAt(0.5), 2'000'000);
    wall.depth.assign(wall.depth.size(), 470);
    lockstep.process(wall.at(34'000'000));
    std::vector<Contact> contacts;
    for (int i = 0; i < 20; ++i) {
        lockstep.queryContacts();
        const Step step = lockstep.step(handAt(0.5), 35'000'000 + 1'000'000 * i);
        contacts.insert(contacts.end(), step.contacts.begin(), step.contacts.begin() + step.contactCount);
    }
    const auto surface = std::ranges::find(contacts, kNoFixture, &Contact::fixture);
    REQUIRE(surface != contacts.end());
    CHECK(surface->normal[2] < -0.9);
    CHECK(wallScene().fixtureName(surface->fixture) == "visible surface");
}
