// SPDX-License-Identifier: Apache-2.0
// Collision shapes that urdfdom drops.
#include "tests/model/urdf_text.h"

#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::testing;

namespace {

std::string shapeText(const std::string& shape) {
    return "<collision><geometry>" + shape + "</geometry></collision>";
}

// Two links of an arm, the second with these elements behind a sound shape.
std::string armWith(const std::string& elements, const std::string& before = "") {
    return ballLink("a") + "<link name='b'>" + before + shapeText("<sphere radius='0.02'/>") + elements +
           "</link>" + jointText("j", "revolute", "a", "b", "0 0 0.3", "0 1 0");
}

bool namesShape(const std::string& elements, const std::string& words, const std::string& before = "") {
    const std::string refusal = urdfRefusal(armWith(elements, before));
    INFO(refusal);
    CHECK(refusal.find(".urdf: link b: ") != std::string::npos);
    CHECK(refusal.find('\n') == std::string::npos);
    CHECK(refusal.find("(allowed: ") != std::string::npos);
    return refusal.find(words) != std::string::npos;
}

} // namespace

TEST_CASE(
    "A collision shape that the parser drops rejects the URDF, with the link, the shape and the reason") {
    for (const char* shape :
         {"<box size='0.1 0.1'/>", "<box size='0.1,0.1,0.2'/>", "<cylinder radius='0.1'/>",
          "<sphere radius='abc'/>", "<mesh filename='a.stl' scale='0.001'/>", "<mesh url='a.stl'/>",
          "<cone radius='1'/>", "<ellipsoid radii='1 1 1'/>"}) {
        CHECK_MESSAGE(namesShape(shapeText(shape), std::string("collision 2 of 2: ") + shape), shape);
    }
    CHECK(namesShape(shapeText(""), "collision 2 of 2: no shape"));
    CHECK(namesShape("<collision/>", "collision 2 of 2: no shape"));
    CHECK(namesShape(shapeText("<box size='1 1'/>") + shapeText("<sphere radius='1'/>"),
                     "collision 2 of 3: <box size='1 1'/>"));
}

TEST_CASE("A second shape of one collision, which the parser does not read, rejects the URDF") {
    for (const char* shapes : {"<box size='0.1 0.1 0.1'/><sphere radius='0.2'/>",
                               "<box size='0.1 0.1 0.1'/><capsule radius='1' length='1'/>",
                               "<box size='0.1 0.1 0.1'/></geometry><geometry><sphere radius='0.2'/>",
                               "<box size='0.1 0.1 0.1'><x/></box><sphere radius='0.2'></sphere>"}) {
        CHECK_MESSAGE(
            namesShape(shapeText(shapes), "collision 2: 2 shapes (allowed: one <collision> per shape)"),
            shapes);
    }
    CHECK(namesShape(shapeText("</geometry><geometry>"), "collision 2 of 2: no shape"));
    CHECK(loadUrdf(armWith(shapeText("<!-- <box/> --><box size='0.1 0.1 0.1'><x/></box>"))).links.size() ==
          2);
}

TEST_CASE("Elements that the parser skips because of their spelling, such as <Collision>, reject the URDF") {
    const std::string ball = "<geometry><sphere radius='0.2'/></geometry>";
    CHECK(namesShape("<Collision>" + ball + "</Collision>", "<Collision>: not read (allowed: <collision>)"));
    CHECK(namesShape("<collision_group><collision>" + ball + "</collision></collision_group>",
                     "<collision_group>: not read (allowed: <collision>)"));
    CHECK(namesShape("<collision><Origin xyz='0 0 1'/>" + ball + "</collision>",
                     "<Origin>: not read (allowed: <origin>)"));
    CHECK(loadUrdf(armWith("<collision_checking/><Visual/>")).links.size() == 2);
}

TEST_CASE("An error in front of the collision shapes of a link, which hides them, rejects the URDF") {
    CHECK(namesShape("", "its collision shapes are lost behind an error: ",
                     "<visual><geometry><box size='1'/></geometry></visual>"));
}

TEST_CASE("Materials and inertial values, which are not read, may have faults") {
    for (const char* element :
         {"<visual><geometry><sphere radius='1'/></geometry><material><color rgba='0 0 0 "
          "1'/></material></visual>",
          "<visual><geometry><sphere radius='1'/></geometry><material/></visual>",
          "<inertial><mass value='heavy'/></inertial>", "<inertial/>",
          "<inertial><origin xyz='0 0'/><mass value='1'/><!-- </inertial> --><inertia ixx='1' ixy='0' "
          "ixz='-0.3\n' iyy='1' iyz='0' izz='1'/></inertial>"}) {
        const ArmModel arm = loadUrdf(armWith(shapeText("<box size='1 1 1'/>"), element));
        CHECK_MESSAGE(arm.links.size() == 2, element);
        CHECK_MESSAGE(arm.notes.empty(), element);
    }
    CHECK(loadUrdf("<material name='m'/><material name='m'/>" + armWith("")).links.size() == 2);
    CHECK(urdfRefusal(armWith("", "<visual><material></visual>")) != "");
    CHECK(urdfRefusal(armWith("", "<material>") + "</material>") != "");
}

TEST_CASE("A link with an inertial and no shapes is a part and not a frame, whatever its values are") {
    const auto notes = [](const std::string& inertial) {
        return loadUrdf(armWith("") + "<link name='d'>" + inertial + "</link>" +
                        jointText("k", "fixed", "b", "d", "0 0 0.1", "0 0 1", ""))
            .notes;
    };
    CHECK(notes("").empty());
    CHECK(notes("<inertial><mass value='heavy'/></inertial>") ==
          std::vector<std::string>{"link d has no collision shape and can enter regions"});
}

TEST_CASE("Words of collisions in comments and in other elements than links are not counted as shapes") {
    const std::string outside = "<gazebo><collision/><link name='b'><collision/></link></gazebo>";
    CHECK(loadUrdf(armWith("<!-- <collision> --><capsule_like/>") + outside).links.size() == 2);
    CHECK(loadUrdf(armWith(shapeText("<capsule radius='0.1' length='0.2'/>"))).links.size() == 2);
}

TEST_CASE("A capsule of Drake's extension is rejected with the name that is read") {
    const std::string refusal = urdfRefusal(
        "<link name='a'><collision><geometry><drake:capsule radius='0.1' length='0.2'/></geometry>"
        "</collision></link>");
    CHECK(refusal.find("(allowed: <capsule> instead of <drake:capsule>; <box ") != std::string::npos);
}
