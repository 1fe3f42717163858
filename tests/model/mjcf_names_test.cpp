// SPDX-License-Identifier: Apache-2.0
// Names that an MJCF leaves out, limits that it takes back, and shapes that are part of the world.
#include "tests/model/mjcf_text.h"

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::testing;

namespace {

// An arm of two joints; before: in the world, next to it; inner: in its last body.
std::string armOfTwo(const std::string& before, const std::string& body, const std::string& joint,
                     const std::string& inner = "") {
    return "<worldbody>" + before + "<body name='base'>" + mjcfBall() + "<body name='" + body +
           "1' pos='0 0 0.1'><joint name='" + joint + "1' range='-90 90'/>" + mjcfBall() + "<body name='" +
           body + "2' pos='0 0 0.2'><joint name='" + joint + "2' axis='0 1 0' range='-90 90'/>" + mjcfBall() +
           inner + "</body></body></body></worldbody>";
}

bool noted(const ArmModel& arm, const std::string& part) {
    return std::any_of(arm.notes.begin(), arm.notes.end(),
                       [&](const std::string& note) { return note.find(part) != std::string::npos; });
}

} // namespace

TEST_CASE("Bodies and joints without a name next to an arm with the usual names do not take those") {
    for (const char* cube :
         {"<body name='cube'><freejoint/>", "<body><freejoint/>", "<body>", "<body><joint/>",
          "<body name='body'><joint/><joint axis='1 0 0'/><joint axis='0 1 0'/>"}) {
        for (const auto& given :
             {std::pair("l", "joint_"), {"body_", "j"}, {"body_", "joint_"}, {"body__", "body__fixed"}}) {
            const auto &body = given.first, &joint = given.second;
            CAPTURE(cube);
            CAPTURE(body);
            const std::string text = armOfTwo(std::string(cube) + mjcfBall() + "</body>", body, joint);
            CHECK(mjcfRefusal(text) == "");
            const ArmModel arm = loadMjcf(text, {.base = "base"});
            REQUIRE(arm.count() == 2);
            CHECK(arm.joints[1].name == std::string(joint) + "2");
        }
    }
}

TEST_CASE("Sites named as the world, as a body or as what joins another one do not collide with it") {
    const std::string sites = "<site name='world'/><site name='base'/><site name='base__site'/>"
                              "<site name='l2__1'/><site name='tool0'/>";
    const ArmModel arm = loadMjcf(armOfTwo("", "l", "tool0__site", sites));
    CHECK(arm.count() == 2);
    CHECK(arm.tipText == "tool0 (a tool frame by its name)");
}

TEST_CASE("A range that does not rise takes back an inherited one unless the joint says that it is limited") {
    const std::string classes = "<default><joint range='-90 90'/></default>";
    const auto jointWith = [&](const std::string& range, const std::string& kind = "hinge") {
        return loadMjcf(classes + "<worldbody><body name='a'>" + mjcfBall() +
                        "<body name='b'><joint name='j' "
                        "type='" +
                        kind + "' " + range + "/>" + mjcfBall() + "</body></body></worldbody>")
            .joints[0];
    };
    CHECK(jointWith("").upper == doctest::Approx(0.5 * M_PI));
    for (const char* range : {"range='0 0'", "range='1 1'", "range='1 -1'", "range='0 0' limited='auto'"}) {
        CAPTURE(range);
        CHECK(jointWith(range).limitsFrom == "continuous");
        CHECK(jointWith(range, "slide").upper == 1e4);
    }
}

TEST_CASE("A plane or height field on a body that does not move is part of the world, and is reported") {
    const ArmModel arm =
        loadMjcf(armOfTwo("<body name='table'><body name='top'><geom type='plane' size='1 1 0.1'/>"
                          "<geom type='hfield' hfield='h'/></body>" +
                              mjcfBall() + "</body>",
                          "l", "j"));
    CHECK(arm.count() == 2);
    CHECK(noted(arm, "2 planes or height fields of bodies that do not move, the first in line 1, are not "
                     "read"));
    CHECK(mjcfRefusal(armOfTwo("", "l", "j", "<geom type='plane' size='1 1 0.1'/>")).find("type=\"plane\"") !=
          std::string::npos);
}
