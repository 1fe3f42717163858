// SPDX-License-Identifier: Apache-2.0
// Arms in MJCF: the same links, joints and limits as those of a URDF that was written by hand.
#include "tests/model/mjcf_text.h"

#include <cmath>
#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::testing;

namespace {

// Centre of the only leaf of a link.
dvec3 mjcfCentre(const ArmModel& arm, const std::string& link, const JointVector& q) {
    ArmFrames frames;
    arm.place(q, Pose{}, frames, 0.0);
    for (size_t i = 0; i < arm.leaves.size(); ++i) {
        if (arm.links[arm.leaves[i].link] == link) {
            return arm.centre(frames, i);
        }
    }
    return dvec3(NAN);
}

void checkEqual(const ArmModel& is, const ArmModel& wanted, const std::vector<std::string>& links) {
    REQUIRE(is.count() == wanted.count());
    for (size_t j = 0; j < is.count(); ++j) {
        CHECK(is.joints[j].name == wanted.joints[j].name);
        CHECK(is.joints[j].slides == wanted.joints[j].slides);
        if (std::isfinite(wanted.joints[j].lower)) {
            CHECK(is.joints[j].lower == doctest::Approx(wanted.joints[j].lower));
            CHECK(is.joints[j].upper == doctest::Approx(wanted.joints[j].upper));
        } else {
            CHECK(is.joints[j].lower == wanted.joints[j].lower);
            CHECK(is.joints[j].upper == wanted.joints[j].upper);
        }
    }
    for (int k = 0; k < 20; ++k) {
        JointVector q{};
        for (size_t j = 0; j < is.count(); ++j) {
            q[j] = std::sin(1.7 * k + 2.3 * static_cast<double>(j));
        }
        for (const std::string& link : links) {
            CAPTURE(link);
            CHECK(glm::distance(mjcfCentre(is, link, q), mjcfCentre(wanted, link, q)) < 1e-9);
        }
    }
}

const std::string kTurns =
    "<limit lower='-1.5707963267948966' upper='1.5707963267948966' velocity='0' effort='0'/>";

std::string origin(const std::string& joint, const std::string& type, const std::string& parent,
                   const std::string& child, const std::string& place, const std::string& axis,
                   const std::string& more = kTurns) {
    return "<joint name='" + joint + "' type='" + type + "'><parent link='" + parent + "'/><child link='" +
           child + "'/><origin " + place + "/><axis xyz='" + axis + "'/>" + more + "</joint>";
}

} // namespace

TEST_CASE("Bodies of an MJCF move as the links of the same arm in URDF, angles in degrees, poses stated in "
          "every way") {
    const ArmModel mjcf = loadMjcf(R"(
<compiler eulerseq='zyx'/>
<default><joint range='-90 90'/><default class='y'><joint axis='0 2 0'/></default></default>
<worldbody><geom type='plane' size='1 1 1'/><body name='a'>)" +
                                   mjcfBall() + R"(
<body name='b' pos='0 0 0.3' euler='30 0 90'><joint name='j1'/>)" +
                                   mjcfBall("0.1 0 0") + R"(
<body name='c' pos='0.2 0 0' axisangle='1 0 0 90'><joint name='j2' class='y'/>)" +
                                   mjcfBall("0 0 0.1") + R"(
<body name='d' pos='0 0.1 0' xyaxes='0 1 0 -1 0 0'><joint name='j3' type='slide' axis='1 0 0' range='-0.1 0.2'/>)" +
                                   mjcfBall("0 0.05 0") + R"(
<body name='e' pos='0 0 0.1' zaxis='0 1 0'><joint name='j4' limited='false'/>)" +
                                   mjcfBall("0.03 0 0") + "</body></body></body></body></body></worldbody>");
    const auto at = [](const std::string& name, const std::string& centre) {
        return "<link name='" + name + "'><collision><origin xyz='" + centre +
               "'/><geometry><sphere radius='0.02'/></geometry></collision></link>";
    };
    // Intrinsic z 30, y 0, x 90 degrees is roll 90, yaw 30.
    const ArmModel urdf = loadUrdf(
        at("world", "9 9 9") + at("a", "0 0 0") + at("b", "0.1 0 0") + at("c", "0 0 0.1") +
        at("d", "0 0.05 0") + at("e", "0.03 0 0") +
        "<joint name='f' type='fixed'><parent link='world'/><child link='a'/></joint>" +
        origin("j1", "revolute", "a", "b", "xyz='0 0 0.3' rpy='1.5707963267948966 0 0.5235987755982988'",
               "0 0 1") +
        origin("j2", "revolute", "b", "c", "xyz='0.2 0 0' rpy='1.5707963267948966 0 0'", "0 1 0") +
        origin("j3", "prismatic", "c", "d", "xyz='0 0.1 0' rpy='0 0 1.5707963267948966'", "1 0 0",
               "<limit lower='-0.1' upper='0.2' velocity='0' effort='0'/>") +
        origin("j4", "continuous", "d", "e", "xyz='0 0 0.1' rpy='-1.5707963267948966 0 0'", "0 0 1", ""));
    checkEqual(mjcf, urdf, {"a", "b", "c", "d", "e"});
}

TEST_CASE("Anchors, several joints of one body, frames and reference angles are those of MuJoCo") {
    const ArmModel arm = loadMjcf(R"(
<compiler angle='radian'/>
<worldbody><body name='a'>)" + mjcfBall() +
                                  R"(
<body name='b' pos='0 0 1'>
  <joint name='turn' axis='0 0 1' pos='0.5 0 0' range='-1 2' ref='0.5'/>
  <joint name='lift' type='slide' axis='0 0 1' range='0 1'/>)" +
                                  mjcfBall() + R"(
  <frame pos='0 0 0.5' axisangle='0 0 1 1.5707963267948966'>
    <body name='c' pos='1 0 0'><joint name='roll' axis='1 0 0' range='-1 1'/>)" +
                                  mjcfBall("0 0 0.1") + R"(</body>
  </frame>
</body></body></worldbody>)");
    REQUIRE(arm.count() == 3);
    CHECK(arm.joints[0].lower == doctest::Approx(-1.5));
    CHECK(arm.joints[0].upper == doctest::Approx(1.5));
    const double quarter = std::acos(-1.0) / 2.0;
    // About (0.5, 0, 1): the body's origin goes from (0, 0, 1) to (0.5, -0.5, 1), then up by 0.2.
    const JointVector q{quarter, 0.2, 0.0};
    CHECK(glm::distance(mjcfCentre(arm, "b", q), dvec3(0.5, -0.5, 1.2)) < 1e-12);
    // The frame turns c to (0, 1, 0.5) of b, which is turned to (-1, 0, 0.5).
    CHECK(glm::distance(mjcfCentre(arm, "c", q), dvec3(-0.5, -0.5, 1.8)) < 1e-12);
    // c's x axis is b's y axis, which points along -x: 0.1 of z goes to +y.
    const JointVector rolled{quarter, 0.2, quarter};
    CHECK(glm::distance(mjcfCentre(arm, "c", rolled), dvec3(-0.5, -0.4, 1.7)) < 1e-12);
}

TEST_CASE("Geoms become shapes of the same size: fromto, half sizes, classes and an ellipsoid in its box") {
    const ArmModel arm = loadMjcf(R"(
<default><default class='limb'><geom type='capsule' size='0.03'/><default class='pad'><geom type='box' size='0.01 0.02 0.03'/></default></default></default>
<worldbody><body name='a' childclass='limb'><geom fromto='0 0 0 0 0 0.4'/>
<body name='b' pos='0 0 0.4'><joint name='j' axis='1 0 0' range='-90 90'/><geom class='pad' pos='1 0 0'/>
<geom type='ellipsoid' size='0.01 0.02 0.05' pos='0 1 0'/><geom type='cylinder' size='0.02 0.1' pos='0 0 1'/>
<geom type='sphere' size='0.5' contype='0' conaffinity='0'/></body></body></worldbody>)");
    dvec3 lowest(INFINITY), highest(-INFINITY);
    bool pad = false, ellipsoid = false, visual = false;
    ArmFrames frames;
    arm.place(JointVector{}, Pose{}, frames, 0.0);
    for (size_t i = 0; i < arm.leaves.size(); ++i) {
        const dvec3 centre = arm.centre(frames, i);
        if (arm.links[arm.leaves[i].link] == "a") {
            lowest = glm::min(lowest, centre - arm.leaves[i].sphere.radius);
            highest = glm::max(highest, centre + arm.leaves[i].sphere.radius);
        }
        pad = pad || glm::distance(centre, dvec3(1.0, 0.0, 0.4)) < 0.03;
        ellipsoid = ellipsoid || glm::distance(centre, dvec3(0.0, 1.0, 0.4)) < 0.06;
        visual = visual || arm.leaves[i].sphere.radius > 0.4;
    }
    CHECK(lowest.z <= -0.03);
    CHECK(lowest.z > -0.04);
    CHECK(highest.z >= 0.43);
    CHECK(highest.z < 0.44);
    CHECK(pad);
    CHECK(ellipsoid);
    CHECK_FALSE(visual);
}

TEST_CASE("An equality of two joints is a mimic joint, and one of a single joint holds it") {
    const std::string bodies = "<compiler angle='radian'/><worldbody><body name='a'>" + mjcfBall() +
                               "<body name='b' pos='0 0 1'><joint name='j1' axis='1 0 0' range='-1 1'/>" +
                               mjcfBall() +
                               "<body name='c' pos='0 0 1'><joint name='j2' axis='1 0 0' range='-2 2'/>" +
                               mjcfBall() + "</body></body></body></worldbody>";
    const ArmModel arm =
        loadMjcf(bodies + "<equality><joint joint1='j2' joint2='j1' polycoef='0.1 -1 0 0 0'/></equality>");
    REQUIRE(arm.joints[1].mimic);
    JointVector q{0.4, 9.0};
    arm.follow(q);
    CHECK(q[1] == doctest::Approx(0.1 - 0.4));
    const ArmModel shifted =
        loadMjcf(bodies + "<equality><joint joint1='j2' joint2='j1' polycoef='0.25'/></equality>");
    REQUIRE(shifted.joints[1].mimic);
    CHECK(shifted.joints[1].mimic->offset == 0.25);
    CHECK(shifted.joints[1].mimic->multiplier == 1.0); // MuJoCo's default of a coefficient that is not given
    const ArmModel held = loadMjcf(bodies + "<equality><joint joint1='j2' polycoef='0.3'/></equality>");
    CHECK(held.joints[1].lower == doctest::Approx(0.3));
    CHECK(held.joints[1].upper == doctest::Approx(0.3));
}

TEST_CASE("Included files are read from the main file's folder, also from within one another") {
    std::ofstream(mjcfFolder() / "limbs.xml")
        << "<mujocoinclude><body name='b' pos='0 0 0.5'><joint name='j' axis='1 0 0' range='-9 9'/>"
        << mjcfBall() << "<include file='more.xml'/></body></mujocoinclude>";
    std::ofstream(mjcfFolder() / "more.xml")
        << "<mujoco><body name='c' pos='0 0 0.5'>" << mjcfBall() << "</body></mujoco>";
    const ArmModel arm = loadMjcf("<worldbody><body name='a'>" + mjcfBall() +
                                  "<include file='limbs.xml'/></body></worldbody>");
    CHECK(glm::distance(mjcfCentre(arm, "c", JointVector{}), dvec3(0.0, 0.0, 1.0)) < 1e-12);
    std::ofstream(mjcfFolder() / "more.xml") << "<mujoco><include file='more.xml'/></mujoco>";
    CHECK(mjcfRefusal("<worldbody><include file='limbs.xml'/></worldbody>").find("64 at most") !=
          std::string::npos);
}

TEST_CASE(
    "What an MJCF states wrongly is refused in one line with line, element, value and what is allowed") {
    const auto in = [](const std::string& body) {
        return "<worldbody>\n<body name='a'>" + body + "</body></worldbody>";
    };
    const std::pair<std::string, std::string> all[]{
        {in("<joint name='j' range='1'/>"),
         "line 2: <joint name=\"j\">: range=\"1\" (allowed: 2 finite numbers)"},
        {in("<joint name='j' axis='0 nan 1'/>"), "axis=\"0 nan 1\" (allowed: 3 finite numbers)"},
        {in("<joint type='screw'/>"), "type=\"screw\" (allowed: hinge, slide, ball or free)"},
        {in("<joint/><geom type='hfield'/>"), "type=\"hfield\""},
        {in("<geom type='box' size='1 1'/>"), "size=\"1 1\" (allowed: 3 finite numbers)"},
        {in("<geom type='capsule' fromto='1 1 1 1 1 1' size='0.1'/>"),
         "fromto of length 0 (allowed: two points)"},
        {in("<geom type='mesh' mesh='none'/>"), "mesh=\"none\" (allowed: a mesh of <asset> with a file)"},
        {in("<geom class='none' size='1'/>"), "class 'none' (allowed: a class of <default>)"},
        {in("<composite/>"), "<composite>: not read"},
        {in("<body name='b' quat='0 0 0 0'/>"), "quat of length 0"},
        {"<compiler coordinate='global'/>" + in(""), "coordinate=\"global\" (allowed: local)"},
        {"<compiler angle='gon'/>" + in(""), "angle=\"gon\" (allowed: degree or radian)"},
        {"<worldbody><body>", "not understood (XML_ERROR_"},
        {"<equality><joint joint1='j' joint2='k' polycoef='0 1 1'/></equality>" + in(""),
         "polycoef with powers above 1"},
        {"<worldbody><include/></worldbody>", "<include>: without file"},
        {"<worldbody><include file='missing.xml'/></worldbody>", "missing.xml"},
    };
    for (const auto& [text, wanted] : all) {
        const std::string line = mjcfRefusal(text);
        const std::string model = text;
        CAPTURE(model);
        CAPTURE(line);
        CHECK(line.find(wanted) != std::string::npos);
        CHECK(line.find('\n') == std::string::npos);
    }
}

TEST_CASE("A thousand nested bodies and a body that is its own parent's name end in one line") {
    std::string deep = "<worldbody>";
    for (int i = 0; i < 1000; ++i) {
        deep += "<body>";
    }
    for (int i = 0; i < 1000; ++i) {
        deep += "</body>";
    }
    CHECK(mjcfRefusal(deep + "</worldbody>").find("XML_ELEMENT_DEPTH_EXCEEDED") != std::string::npos);
    CHECK_FALSE(mjcfRefusal("<worldbody><body name='a'><body name='a'/></body></worldbody>").empty());
}
