// SPDX-License-Identifier: Apache-2.0
// Names of tool frames, and the frames below a chosen tip.
#include "tests/model/urdf_text.h"

#include <algorithm>
#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::testing;

namespace {

// l0 to l3, with joints in one line.
std::string armOfThree() {
    std::string urdf = ballLink("l0");
    for (int k = 1; k <= 3; ++k) {
        const std::string before = "l" + std::to_string(k - 1), after = "l" + std::to_string(k);
        urdf += ballLink(after) + jointText("q" + std::to_string(k), "revolute", before, after, "0 0 0.3",
                                            k % 2 == 0 ? "1 0 0" : "0 1 0");
    }
    return urdf;
}

std::string fixedTo(const std::string& parent, const std::string& name, const std::string& link,
                    const std::string& at = "0 0 0.1") {
    return link + jointText("f_" + name, "fixed", parent, name, at, "0 0 1");
}

std::string frame(const std::string& parent, const std::string& name, const std::string& at = "0 0 0.1") {
    return fixedTo(parent, name, "<link name='" + name + "'/>", at);
}

} // namespace

TEST_CASE("The frame of a gripper is the tip before the gripper's link if only the link has shapes") {
    const std::string gripper = armOfThree() + fixedTo("l3", "gripper_link", ballLink("gripper_link"));
    for (const std::string name : {"gripper_frame_link", "left_gripper_frame_link", "gripperframe"}) {
        const ArmModel bare = loadUrdf(gripper + frame("gripper_link", name));
        CHECK(bare.tipText == name + " (a tool frame by its name)");
        CHECK(bare.notes.empty());
        CHECK(loadUrdf(gripper + fixedTo("gripper_link", name, ballLink(name))).tipText ==
              "gripper_link (a tool frame by its name)");
        CHECK(loadUrdf(gripper + frame("gripper_link", name) + frame("l3", "tool0")).tipText ==
              "tool0 (a tool frame by its name)");
    }
}

TEST_CASE("Other spellings of an end effector are tips only where no other tool frame is") {
    for (const std::string name : {"EndEffector_Link", "pinch_site"}) {
        const std::string end = armOfThree() + fixedTo("l3", name, ballLink(name));
        CHECK(loadUrdf(end).tipText == name + " (a tool frame by its name)");
        CHECK(loadUrdf(end + frame("l3", "gripper_link")).tipText ==
              "gripper_link (a tool frame by its name)");
    }
}

TEST_CASE("Frames without shapes below the chosen tip are named in a note") {
    const auto notes = [](const std::string& more) {
        return loadUrdf(armOfThree() + fixedTo("l3", "hand", ballLink("hand")) + more).notes;
    };
    CHECK(notes(frame("hand", "same", "0 0 0")).empty());
    CHECK(notes(frame("l3", "beside")).empty());
    CHECK(notes(frame("hand", "a") + frame("hand", "same", "0 0 0") + frame("same", "b")) ==
          std::vector<std::string>{
              "frames without shapes are fixed to the tip hand; arm.tip selects one: a, b"});
    CHECK(notes(frame("hand", "camera_link") + frame("hand", "force_site") + frame("hand", "hand__site"))
              .empty());
    std::string many;
    for (const char* name : {"a", "b", "c", "d", "e", "f", "g", "i"}) {
        many += frame("hand", name);
    }
    REQUIRE(notes(many).size() == 1);
    CHECK(notes(many)[0].ends_with("selects one: a, b, c, d, e, f and 2 more"));
}

TEST_CASE("A tool frame on a shorter branch than the longest chain is named in a note") {
    std::string hose;
    std::string before = "l1";
    for (const std::string after : {"h1", "h2", "h3", "h4", "h5"}) {
        hose += ballLink(after) + jointText("turn_" + after, "revolute", before, after, "0 0 0.05", "0 0 1");
        before = after;
    }
    const ArmModel arm = loadUrdf(armOfThree() + hose + frame("l3", "tool0"));
    CHECK(arm.tipText == "h5 (the end of the longest chain)");
    CHECK(std::ranges::count(
              arm.notes, "tip h5 has more joints than tool0 on other branches; arm.tip selects another") ==
          1);
    const ArmModel same = loadUrdf(armOfThree() + hose + frame("l1", "hand"));
    for (const std::string& note : same.notes) {
        CHECK(note.find("has more joints") == std::string::npos);
    }
}
