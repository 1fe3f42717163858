// SPDX-License-Identifier: Apache-2.0
// Rules of MuJoCo that a URDF does not have, and what is reported about an MJCF.
#include "tests/model/mjcf_text.h"

#include <algorithm>
#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::testing;

TEST_CASE("A slide without limits, as of a gantry, has a URDF's limits of 10 km and a note") {
    for (const char* limited : {"", "limited='false' range='-1 1'"}) {
        const ArmModel arm = loadMjcf("<worldbody><body name='a'>" + mjcfBall() +
                                      "<body name='b'><joint name='rail' type='slide' axis='1 0 0' " +
                                      limited + "/>" + mjcfBall() + "</body></body></worldbody>");
        REQUIRE(arm.count() == 1);
        CHECK(arm.joints[0].slides);
        CHECK(arm.joints[0].lower == -1e4);
        CHECK(arm.joints[0].upper == 1e4);
        CHECK(std::any_of(arm.notes.begin(), arm.notes.end(), [](const std::string& note) {
            return note.find("joint rail: limits -10000 to 10000 m span more than 5 m") == 0;
        }));
    }
}

TEST_CASE("Constraints of an MJCF that are not read, as of closed loops, are reported") {
    const ArmModel arm =
        loadMjcf("<equality><connect body1='a' body2='b' anchor='0 0 0'/><weld body1='a' body2='b'/>"
                 "<weld active='false' body1='a'/></equality><worldbody><body name='a'>" +
                 mjcfBall() + "<body name='b'><joint name='j' range='-90 90'/>" + mjcfBall() +
                 "</body></body></worldbody>");
    CHECK(std::any_of(arm.notes.begin(), arm.notes.end(), [](const std::string& note) {
        return note == "2 equalities that are no <joint>, the first <connect> in line 1, are not read: loops "
                       "stay open";
    }));
}

TEST_CASE("An equality that its class switches off is not followed, unless it is active itself") {
    const auto with = [](const std::string& classes, const std::string& own) {
        return loadMjcf("<default>" + classes + "</default><equality><joint joint1='k' joint2='j' " + own +
                        "/><weld body1='a' body2='b' " + own + "/></equality><worldbody><body name='a'>" +
                        mjcfBall() + "<body name='b'><joint name='j' range='-90 90'/>" + mjcfBall() +
                        "<body name='c'><joint name='k' range='-90 90'/>" + mjcfBall() +
                        "</body></body></body></worldbody>");
    };
    const auto follows = [&](const std::string& classes, const std::string& own) {
        const ArmModel arm = with(classes, own);
        const bool noted = std::any_of(arm.notes.begin(), arm.notes.end(), [](const std::string& note) {
            return note.find("equalities that are no <joint>") != std::string::npos;
        });
        CHECK(noted == arm.joints.at(1).mimic.has_value()); // the weld is not read
        return noted;
    };
    const std::string off = "<equality active='false'/>",
                      inner = "<default class='off'>" + off + "</default>";
    CHECK_FALSE(follows(off, ""));
    CHECK_FALSE(follows(inner, "class='off'"));
    CHECK_FALSE(follows(off + "<default class='in'/>", "class='in'"));
    CHECK(follows(off, "active='true'"));
    CHECK(follows(inner, ""));
    CHECK(follows("<joint active='false'/>", "")); // of joints, not of equalities
    CHECK(mjcfRefusal("<equality><weld class='none'/></equality>").find("<weld>: class 'none' (allowed: ") !=
          std::string::npos);
}

TEST_CASE("A turn that an element states itself, in any form, replaces the quat of its class") {
    const std::string classes = "<default><geom quat='0 1 0 0' type='capsule' size='0.01 0.1'/></default>";
    const auto top = [&](const std::string& turn) { // highest point of the capsule
        const ArmModel arm =
            loadMjcf("<compiler angle='radian'/>" + classes + "<worldbody><body name='a'>" + mjcfBall() +
                     "<body name='b'><joint name='j' range='-1 1'/><geom name='g' " + turn +
                     "/></body></body></worldbody>");
        double highest = 0.0;
        for (const ArmLeaf& leaf : arm.leaves) {
            highest = std::max(highest, leaf.sphere.centre.z);
        }
        return highest;
    };
    CHECK(top("") > 0.05);
    for (const char* turn : {"euler='0 1.5707963267948966 0'", "axisangle='0 1 0 1.5707963267948966'",
                             "xyaxes='0 0 1 0 1 0'", "zaxis='1 0 0'", "quat='1 0 1 0'"}) {
        CHECK_MESSAGE(top(turn) < 0.02, turn);
    }
    CHECK(mjcfRefusal("<worldbody><body name='b' euler='1 0 0' zaxis='1 0 0'/></worldbody>")
              .find("<body name=\"b\">: euler and zaxis (allowed: one of quat, axisangle, euler, xyaxes and "
                    "zaxis)") != std::string::npos);
}

TEST_CASE("Elements of one kind in a class add their attributes, the last one first") {
    const auto leaves = [](const std::string& defaults) {
        return loadMjcf("<default>" + defaults + "</default><worldbody><body name='a'>" + mjcfBall() +
                        "<body name='b'><joint name='j' range='-1 1'/><geom/></body></body></worldbody>")
            .leaves;
    };
    CHECK(leaves("<geom size='0.5'/><geom size='0.03' type='sphere'/>").back().sphere.radius == 0.03);
    CHECK(leaves("<geom size='0.03'/><geom type='sphere'/>").size() == 2);
    CHECK(mjcfRefusal("<default><geom contype='0' conaffinity='0'/><geom size='0.03'/></default><worldbody>"
                      "<body name='a'><body name='b'><joint name='j' range='-1 1'/><geom/></body></body>"
                      "</worldbody>")
              .find("collision: no shapes on any link") != std::string::npos);
}

TEST_CASE("A size with fewer numbers than the geom needs keeps the others of its class and those above") {
    const auto reach = [](const std::string& classes,
                          const std::string& geom) { // of b's geom from its centre
        const ArmModel arm = loadMjcf("<default>" + classes + "</default><worldbody><body name='a'>" +
                                      mjcfBall() + "<body name='b'><joint name='j' range='-90 90'/><geom " +
                                      geom + "/></body></body></worldbody>");
        dvec3 most(0.0);
        for (const ArmLeaf& leaf : arm.leaves) {
            const bool own = arm.links[leaf.link] == "b";
            most = own ? glm::max(most, glm::abs(leaf.sphere.centre) + leaf.sphere.radius) : most;
        }
        return most;
    };
    const std::string capsule = "<geom type='capsule' size='0.03 0.2'/>";
    const dvec3 whole = reach("", "type='capsule' size='0.05 0.2'");
    CHECK(reach(capsule, "size='0.05'") == whole); // as in MuJoCo 3.2
    CHECK(reach(capsule + "<default class='c'><geom size='0.05'/></default>", "class='c'") == whole);
    CHECK(reach(capsule + "<geom size='0.05'/>", "") == whole);
    const std::string box = "<geom type='box' size='0.3 0.2 0.1'/>";
    CHECK(reach(box, "size='0.1 0.1'") == reach("", "type='box' size='0.1 0.1 0.1'"));
    CHECK(reach(box + "<default class='c'><geom size='1 0.1'/></default>", "class='c' size='0.1'") ==
          reach("", "type='box' size='0.1 0.1 0.1'"));
    const auto refusalOfGeom = [](const std::string& classes, const std::string& geom) {
        return mjcfRefusal("<default>" + classes + "</default><worldbody><body><geom " + geom +
                           "/></body></worldbody>");
    };
    CHECK(refusalOfGeom("<geom size='0.03'/>", "type='capsule' size='0.05'")
              .find("size=\"0.05\" (allowed: 2..3 finite numbers)") != std::string::npos);
    CHECK(refusalOfGeom("<geom size='0.03 x'/>", "type='capsule' size='0.05'").find("size=\"0.03 x\"") !=
          std::string::npos);
    CHECK(refusalOfGeom("<geom pos='0 0 1'/>", "size='0.05' pos='0 0'").find("pos=\"0 0\" (allowed: 3") !=
          std::string::npos);
}

TEST_CASE("Geoms of a contact pair are collision shapes, whatever contype and conaffinity say") {
    const auto leaves = [](const std::string& pair) {
        return loadMjcf("<worldbody><geom name='floor' type='plane' size='1 1 1'/><body name='a'>" +
                        mjcfBall() +
                        "<body name='b'><joint name='j' range='-1 1'/><geom name='guard' size='0.03' "
                        "contype='0' conaffinity='0'/></body></body></worldbody>" +
                        pair)
            .leaves.size();
    };
    CHECK(leaves("") == 1);
    CHECK(leaves("<contact><exclude body1='a' body2='b'/><pair geom1='guard' geom2='floor'/></contact>") ==
          2);
    CHECK(leaves("<contact/><contact><pair geom1='floor' geom2='guard'/></contact>") == 2);
}

TEST_CASE("A primitive that is fitted to a mesh becomes the mesh, with one note") {
    std::ofstream(mjcfFolder() / "tetra.obj")
        << "v 0 0 0\nv 0.1 0 0\nv 0 0.1 0\nv 0 0 0.1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
    const std::string fitted = "<geom type='capsule' mesh='tetra'/><geom type='box' mesh='tetra'/>";
    const ArmModel arm =
        loadMjcf("<asset><mesh file='tetra.obj'/></asset><worldbody><body name='a'>" + mjcfBall() +
                 "<body name='b'><joint name='j' range='-90 90'/>" + fitted + "</body></body></worldbody>");
    CHECK(arm.links == std::vector<std::string>{"a", "b"});
    CHECK(std::count(arm.notes.begin(), arm.notes.end(),
                     "2 primitives are fitted to meshes: the meshes are covered instead") == 1);
}

TEST_CASE("A fault in an included file is reported with that file and its line") {
    std::ofstream(mjcfFolder() / "hand.xml")
        << "<mujoco><worldbody>\n<body>\n<geom type='box' size='1'/></body></worldbody></mujoco>";
    std::ofstream(mjcfFolder() / "robot.xml")
        << "<mujoco>\n<include file='hand.xml'/>\n<composite/></mujoco>";
    const std::string line = mjcfRefusal("<include file='robot.xml'/>");
    CAPTURE(line);
    CHECK(line.find("hand.xml: line 3: <geom>: size=\"1\"") != std::string::npos);
    CHECK(line.find("arm.xml") == std::string::npos);
}

TEST_CASE("The tip of an MJCF is a body, also where its joint has an anchor off the body's origin") {
    const ArmModel arm = loadMjcf("<worldbody><body name='a'>" + mjcfBall() +
                                  "<body name='b'><joint name='j' pos='0.1 0 0' range='-90 90'/>" +
                                  mjcfBall() + "</body></body></worldbody>");
    CHECK(arm.tipText == "b (the end of the longest chain)");
}

TEST_CASE("A site of an MJCF can be the tip, and one with a usual name is") {
    const auto with = [](const std::string& sites, const std::string& tip = "") {
        ArmOptions options;
        options.tip = tip;
        return loadMjcf(
            "<default><site pos='0 0 0.5'/></default><worldbody><site name='far'/><body name='a'>" +
                mjcfBall() + "<body name='b' pos='0 0 0.3'><joint name='j' range='-90 90'/>" + mjcfBall() +
                sites + "</body></body></worldbody>",
            options);
    };
    const std::string flange = "<site name='attachment_site' pos='0.1 0 0' euler='0 90 0'/>";
    const ArmModel arm = with(flange + "<site/><site name='imu' pos='0 1 0'/>");
    CHECK(arm.tipText == "attachment_site (a tool frame by its name)");
    CHECK(glm::distance(arm.lastTtip.position, dvec3(0.1, 0.0, 0.0)) < 1e-12);
    CHECK(glm::distance(arm.lastTtip.rotation * dvec3(0.0, 0.0, 1.0), dvec3(1.0, 0.0, 0.0)) < 1e-12);
    CHECK(arm.notes.size() == with("").notes.size()); // a site has nothing that could enter a region
    CHECK(with("<site name='imu'/>").tipText == "b (the end of the longest chain)");
    const ArmModel named = with("<frame pos='0.2 0 0'><site name='imu'/></frame>", "imu");
    CHECK(glm::distance(named.lastTtip.position, dvec3(0.2, 0.0, 0.5)) < 1e-12); // with its class
    CHECK(with("<site name='b'/>", "b__site").lastTtip.position.z == doctest::Approx(0.5));
}

TEST_CASE("A site with fromto lies between its ends, and its z axis leads from the second to the first") {
    const auto with = [](const std::string& site) {
        ArmOptions options;
        options.tip = "s";
        return loadMjcf("<default><default class='c'><site type='capsule' fromto='0 0 0 0 0 2'/></default>"
                        "</default><worldbody><body name='a'>" +
                            mjcfBall() + "<body name='b'><joint name='j' range='-90 90'/>" + mjcfBall() +
                            site + "</body></body></worldbody>",
                        options)
            .lastTtip;
    };
    // MuJoCo 3.2, mjCSite::Compile: pos = (from + to) / 2, z along from - to, also for attributes of a class.
    const Pose along = with("<site name='s' type='box' size='0.01' fromto='0.1 0 0 0.3 0 0'/>");
    CHECK(glm::distance(along.position, dvec3(0.2, 0.0, 0.0)) < 1e-12);
    CHECK(glm::distance(along.rotation * dvec3(0.0, 0.0, 1.0), dvec3(-1.0, 0.0, 0.0)) < 1e-12);
    CHECK(glm::distance(along.rotation * dvec3(0.0, 1.0, 0.0), dvec3(0.0, 1.0, 0.0)) < 1e-12);
    const Pose inherited = with("<site name='s' class='c'/>");
    CHECK(glm::distance(inherited.position, dvec3(0.0, 0.0, 1.0)) < 1e-12);
    CHECK(glm::distance(inherited.rotation * dvec3(0.0, 1.0, 0.0), dvec3(0.0, -1.0, 0.0)) < 1e-12);
    CHECK(mjcfRefusal("<worldbody><body><site name='s' fromto='0 0 1 0 0 1'/></body></worldbody>")
              .find("fromto of length 0") != std::string::npos);
}

TEST_CASE(
    "Elements and attributes of an MJCF that MuJoCo does not know, as misspelt ones, are reported once") {
    const auto notesOf = [](const std::string& joint, const std::string& more) {
        std::vector<std::string> notes =
            loadMjcf("<default><joint damping='1'/></default><worldbody><body name='a'>" + mjcfBall() +
                     "<body name='b'><joint name='j' axis='0 1 0' " + joint + "/>" + mjcfBall() + more +
                     "</body></body></worldbody><tendon><fixed><joint joint='j' coef='1'/></fixed></tendon>")
                .notes;
        std::erase_if(notes, [](const auto& note) { return note.find("is unknown") == std::string::npos; });
        return notes;
    };
    CHECK(
        notesOf("range='-90 90'", "<inertial pos='0 0 0' mass='1'/><site name='s' euler='0 0 1'/>").empty());
    CHECK(notesOf("rang='-90 90'", "<Geom size='1'/><Geom/><geom Pos='0 0 1' size='0.1'/>") ==
          std::vector<std::string>{"line 1: <joint rang=...> is unknown to MuJoCo and not read",
                                   "line 1: <Geom> is unknown to MuJoCo and not read",
                                   "line 1: <geom Pos=...> is unknown to MuJoCo and not read"});
}
