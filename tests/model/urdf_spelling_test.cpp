// SPDX-License-Identifier: Apache-2.0
// Elements and attributes of a URDF that urdfdom skips.
#include "tests/model/urdf_text.h"

#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::testing;

namespace {

const std::string kLimit = "<limit lower='-2' upper='2' velocity='1' effort='1'/>";

// Links a, b and c, joints j1 and j2; j2 has these elements.
std::string armOf(const std::string& elements, const std::string& links = ballLink("c")) {
    return ballLink("a") + ballLink("b") + links + jointText("j1", "revolute", "a", "b", "0 0 0.3", "0 1 0") +
           "<joint name='j2' type='revolute'><parent link='b'/><child link='c'/>" + elements + "</joint>";
}

bool refuses(const std::string& inside, const std::string& wanted) {
    const std::string refusal = urdfRefusal(inside);
    INFO(refusal);
    CHECK(refusal.find('\n') == std::string::npos);
    return refusal.find(".urdf: " + wanted) != std::string::npos;
}

} // namespace

TEST_CASE("Elements of joints that the parser skips because of their spelling reject the URDF") {
    for (const auto& [written, meant] : {std::pair{"Origin", "origin"},
                                         {"orgin", "origin"},
                                         {"pose", "origin"},
                                         {"position", "origin"},
                                         {"rotation", "origin"},
                                         {"Axis", "axis"},
                                         {"axes", "axis"},
                                         {"Mimic", "mimic"},
                                         {"limits", "limit"}}) {
        const std::string element = written;
        CHECK_MESSAGE(refuses(armOf(kLimit + "<" + element + " xyz='0 0 1'/>"),
                              "joint j2: <" + element + ">: not read (allowed: <" + meant + ">)"),
                      element);
    }
    CHECK(urdfRefusal(armOf(kLimit + "<dynamics damping='1'/><anchor/><traits/><a:limit/>"
                                     "<joint_properties/><safety_controller k_velocity='1'/>")) == "");
}

TEST_CASE("Attributes of joints and collisions that the parser skips reject the URDF") {
    const auto joint = [](const std::string& element) {
        return armOf(kLimit + "<axis xyz='0 1 0'/>" + element);
    };
    CHECK(refuses(joint("<origin position='0 0 1'/>"),
                  "joint j2: <origin position=...>: not read (allowed: xyz, rpy)"));
    CHECK(refuses(joint("<origin xyz='0 0 1' RPY='0 0 1'/>"), "joint j2: <origin RPY=...>: not read"));
    CHECK(refuses(joint("<origin xyz='0 0 1'\n quat_xyzw = \"0 0 0 1\"/>"),
                  "joint j2: <origin quat_xyzw=...>: not read"));
    CHECK(refuses(joint("<mimic joint='j1' multiplyer='-1'/>"),
                  "joint j2: <mimic multiplyer=...>: not read (allowed: joint, multiplier, offset)"));
    CHECK(refuses(joint("<mimic joint='j1' ratio='-1'/>"), "joint j2: <mimic ratio=...>: not read"));
    CHECK(
        refuses(armOf(kLimit + "<axis xzy='0 1 0'/>"), "joint j2: <axis xzy=...>: not read (allowed: xyz)"));
    CHECK(refuses(armOf("<limit lower='-1' uper='1' velocity='1' effort='1'/>"),
                  "joint j2: <limit uper=...>: not read (allowed: lower, upper, effort, velocity)"));
    CHECK(urdfRefusal(armOf("<limit lower='-1' upper='1' velocity='1' effort='1' current='3' k_velocity='1' "
                            "gear_velocity='2' command_effort='1' drake:acceleration='1'/>"
                            "<axis xyz='0 1 0' rpy='0 0 0'/>")) == "");
    const auto part = [](const std::string& at, const std::string& shape) {
        return armOf(kLimit, "<link name='c'><collision>" + at + "<geometry>" + shape +
                                 "</geometry></collision></link>");
    };
    CHECK(refuses(part("<origin pos='0 0 1'/>", "<sphere radius='1'/>"),
                  "link c: <origin pos=...>: not read (allowed: xyz, rpy)"));
    CHECK(refuses(part("", "<mesh filename='a.stl' Scale='1 1 1'/>"),
                  "link c: <mesh Scale=...>: not read (allowed: filename, scale)"));
}

TEST_CASE("Links, joints and collisions where the parser does not look for them reject the URDF") {
    CHECK(refuses(armOf(kLimit) + "<Link name='d'/>", "robot: <Link>: not read (allowed: <link>)"));
    CHECK(refuses(armOf(kLimit) + "<joints name='d'/>", "robot: <joints>: not read (allowed: <joint>)"));
    CHECK(refuses(armOf(kLimit) + "<group>" + ballLink("d") + "</group>",
                  "robot: <link> in <group>: not read (allowed: <link> in <robot>)"));
    CHECK(refuses(armOf(kLimit, "<link name='c'><visual><collision/></visual></link>"),
                  "link c: <collision> in <visual>: not read (allowed: <collision> in <link>)"));
    CHECK(
        refuses(armOf(kLimit, "<link name='c'><collision><geometry><origin xyz='0 0 1'/><sphere radius='1'/>"
                              "</geometry></collision></link>"),
                "link c: <origin> in <geometry>: not read (allowed: <origin> in <collision>)"));
    CHECK(urdfRefusal(armOf(kLimit) + "<RefLink/><gazebo>" + ballLink("d") +
                      "</gazebo><group><link name='a'/></group>"
                      "<transmission><joint name='j1' type='x'/></transmission>") == "");
}

TEST_CASE("A second element of which the parser reads the first rejects the URDF unless both are equal") {
    for (const auto& [name, first, second] : {std::tuple{"origin", "xyz='0 0 0.3'", "xyz='0 0 0.5'"},
                                              {"limit", "lower='-2' upper='2' velocity='1' effort='1'",
                                               "lower='-1' upper='1' velocity='1' effort='1'"},
                                              {"axis", "xyz='0 1 0'", "xyz='1 0 0'"},
                                              {"mimic", "joint='j1'", "joint='j1' offset='1'"},
                                              {"parent", "link='a'", "link='b'"},
                                              {"child", "link='a'", "link='c'"}}) {
        const std::string element = name, one = "<" + element + " " + first + "/>",
                          other = "<" + element + " " + second + "></" + element + ">",
                          more = element == "limit" ? "" : kLimit;
        CHECK_MESSAGE(
            refuses(armOf(more + one + other),
                    "joint j2: several <" + element + "> that differ (allowed: one <" + element + ">)"),
            element);
    }
    CHECK(urdfRefusal(armOf(kLimit + kLimit + "<axis xyz='0 1 0'/><axis  xyz='0 1 0'></axis>")) == "");
    CHECK(refuses(armOf(kLimit, "<link name='c'><collision><origin xyz='0 0 1'/><origin xyz='0 0 2'/>"
                                "<geometry><sphere radius='1'/></geometry></collision></link>"),
                  "link c: several <origin> that differ"));
}

TEST_CASE("Turns of over a full turn, and one limit without the other, are reported in one line each") {
    const auto notes = [](const std::string& elements, const std::string& more = "") {
        return loadUrdf(armOf(elements, "<link name='c'><collision>" + more +
                                            "<geometry><sphere radius='0.1'/></geometry></collision></link>"))
            .notes;
    };
    CHECK(notes(kLimit + "<origin xyz='0 0 1' rpy='0 0 90'/>") ==
          std::vector<std::string>{"joint j2: rpy 0 0 90 is more than a turn; in degrees?"});
    CHECK(notes(kLimit, "<origin rpy='-45 0 0'/>") ==
          std::vector<std::string>{"link c: rpy -45 0 0 is more than a turn; in degrees?"});
    CHECK(notes(kLimit + "<origin rpy='0 -6.28319 4.71'/>").empty());
    CHECK(notes("<limit lower='-1' velocity='1' effort='1'/>") ==
          std::vector<std::string>{"joint j2: <limit> has no upper, which is 0 then"});
    CHECK(notes("<limit upper='1' velocity='1' effort='1'/>") ==
          std::vector<std::string>{"joint j2: <limit> has no lower, which is 0 then"});
}

TEST_CASE("Tabs and line ends between the numbers of an attribute are spaces, as XML says") {
    const ArmModel arm = loadUrdf(armOf(kLimit + "<origin xyz='\n0\t0\r\n0.3'/><axis\txyz='0\t1\n0'/>"));
    CHECK(arm.joints.at(1).before.position.z == doctest::Approx(0.3));
    CHECK(arm.joints.at(1).axis.y == 1.0);
}

TEST_CASE("An element of xacro beside links and joints gives a note, and any other rejects the URDF") {
    const ArmModel arm = loadUrdf(armOf(kLimit) + "<gazebo><xacro:grey a='1'/><xacro:grey/></gazebo>");
    CHECK(arm.notes == std::vector<std::string>{"<xacro:grey> in <gazebo> is not expanded and not read"});
    const std::string wanted = "robot: a xacro file (allowed: a URDF; expand it with: xacro ";
    CHECK(refuses(armOf(kLimit) + "<xacro:arm/>", wanted));
    CHECK(refuses(armOf(kLimit + "<xacro:limits/>"), wanted));
    CHECK(refuses(armOf(kLimit) + "<gazebo><xacro:property name='a' value='1'/></gazebo>", wanted));
}

TEST_CASE("Spaces and line ends around a number of an attribute are skipped") {
    const ArmModel arm = loadUrdf(armOf("<limit lower=' -1.5 ' upper='\n2\n' velocity='1\t' effort='1 '/>"));
    CHECK(arm.joints.at(1).lower == -1.5);
    CHECK(arm.joints.at(1).upper == 2.0);
}

TEST_CASE(
    "An expression of xacro in a visual that is not read gives a note, and any other rejects the URDF") {
    const auto robot = [](const std::string& visual, const std::string& shape = "<sphere radius='0.1'/>") {
        return armOf(kLimit, "<link name='c'>" + visual + "<collision><geometry>" + shape +
                                 "</geometry></collision></link>");
    };
    const auto visual = [](const std::string& shape, const std::string& more = "") {
        return "<visual><geometry>" + shape + "</geometry>" + more + "</visual>";
    };
    const std::string ball = "<sphere radius='0.1'/>", grey = "<material name='${name}_grey'/>";
    const std::string note = "an expression of xacro in <material> in <visual> is not expanded and not read";
    const ArmModel arm = loadUrdf("<material name='${name}_grey'><color rgba='0 0 0 1'/></material>" +
                                  robot(visual(ball, grey) + visual(ball, grey)));
    CHECK(arm.notes == std::vector<std::string>{note});
    CHECK(urdfRefusal(robot("<visual name='${v}'>" + visual(ball).substr(8))) == "");
    CHECK(urdfRefusal(robot(visual("<mesh filename='${mesh}'/>"))) == "");
    const std::string wanted = "robot: a xacro file (allowed: a URDF; expand it with: xacro ";
    for (const std::string& text :
         {robot(visual("<sphere radius='${r}'/>")), robot(visual("<mesh filename='a' scale='${s}'/>")),
          robot(visual(ball, "<origin xyz='${x} 0 0'/>")), robot("", "<sphere radius='${r}'/>"),
          robot("", "<mesh filename='$(find p)/a.stl'/>"), armOf(kLimit + "<origin xyz='0 0 ${z}'/>"),
          armOf(kLimit) + ballLink("${name}_d")}) {
        CHECK_MESSAGE(refuses(text, wanted), text);
    }
}

TEST_CASE("Joints that close loops are reported as not read") {
    const std::string loop =
        "<loop_joint name='bar' type='spherical'><link1 link='a'/><link2 link='c'/></loop_joint>";
    CHECK(loadUrdf(
              armOf(kLimit) + "<gazebo><joint name='weld' type='fixed'/></gazebo>" + loop +
              "<gazebo><joint name='pin' type='revolute'><parent>a</parent><child>c</child></joint></gazebo>")
              .notes ==
          std::vector<std::string>{
              "2 joints of <loop_joint> or <gazebo>, the first bar, are not read: loops stay open"});
}
