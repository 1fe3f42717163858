// SPDX-License-Identifier: Apache-2.0
// Mimic joints and limits that a URDF states for ros2_control and Gazebo only.
#include "tests/model/urdf_text.h"

#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::testing;

namespace {

// j1 and j2 in a row; more: elements of the robot; second: elements of j2.
std::string controlledChain(const std::string& more, const std::string& second = "",
                            const std::string& first = "") {
    const std::string limit = "<limit lower='-2' upper='2' velocity='1' effort='1'/>";
    return ballLink("a") + ballLink("b") + ballLink("c") +
           jointText("j1", "revolute", "a", "b", "0 0 0.2", "1 0 0", limit + first) +
           jointText("j2", "revolute", "b", "c", "0 0 0.4", "1 0 0", limit + second) + more;
}

std::string paramText(const std::string& name, const std::string& value) {
    return "<param name='" + name + "'>" + value + "</param>";
}

std::string controlText(const std::string& joint, const std::string& inside) {
    return "<ros2_control name='s' type='system'><hardware><plugin>x/Y</plugin></hardware><joint name='" +
           joint + "'>" + inside + "<state_interface name='position'/></joint></ros2_control>";
}

std::string pluginText(const std::string& leader, const std::string& joint, const std::string& more = "") {
    return "<gazebo><plugin name='m' filename='libroboticsgroup_gazebo_mimic_joint_plugin.so'><joint>" +
           leader + "</joint><mimicJoint> " + joint + "\n</mimicJoint>" + more + "</plugin></gazebo>";
}

const std::string kControlled = controlText("j2", paramText("mimic", "j1") + paramText("multiplier", "-0.5") +
                                                      paramText("offset", "0.25"));

} // namespace

TEST_CASE("A joint without mimic follows another one as ros2_control or a plugin of Gazebo states") {
    const std::string plugin =
        pluginText("j1", "j2", "<!-- half --><multiplier>-0.5</multiplier><offset>0.25</offset>");
    for (const auto& [more, place] :
         {std::pair{kControlled, "<ros2_control>"}, {plugin, "a plugin of <gazebo>"}}) {
        const ArmModel arm = loadUrdf(controlledChain(more));
        REQUIRE(arm.joints.at(1).mimic);
        CHECK(arm.joints[1].mimic->multiplier == -0.5);
        CHECK(arm.joints[1].mimic->offset == 0.25);
        CHECK(arm.notes ==
              std::vector<std::string>{"joint j2: has no <mimic>; it follows j1, multiplier -0.5, "
                                       "offset 0.25, as " +
                                       std::string(place) + " states"});
    }
    const ArmModel plain = loadUrdf(controlledChain(controlText("j2", paramText("mimic", "j1"))));
    REQUIRE(plain.joints.at(1).mimic);
    CHECK(plain.joints[1].mimic->multiplier == 1.0);
}

TEST_CASE("Where several places state other mimics, that of the joint counts, and a note says so") {
    const ArmModel same = loadUrdf(
        controlledChain(kControlled + kControlled, mimicText("j1", "multiplier='-0.5' offset='0.25'")));
    CHECK(same.notes.empty());
    const ArmModel own = loadUrdf(controlledChain(kControlled, mimicText("j1")));
    CHECK(own.joints.at(1).mimic->multiplier == 1.0);
    CHECK(own.notes == std::vector<std::string>{
                           "joint j2: its mimic in <ros2_control> (follows j1, multiplier -0.5, offset "
                           "0.25) is not used: that of <mimic> (follows j1, multiplier 1, offset 0) "
                           "differs"});
    const ArmModel first = loadUrdf(controlledChain(kControlled + pluginText("j1", "j2")));
    CHECK(first.joints.at(1).mimic->multiplier == -0.5);
    REQUIRE(first.notes.size() == 2);
    CHECK(first.notes[1].find("that of another place (follows j1, multiplier -0.5") != std::string::npos);
    const ArmModel back = loadUrdf(controlledChain(kControlled, "", mimicText("j2")));
    CHECK_FALSE(back.joints.at(1).mimic);
    REQUIRE(back.notes.size() == 1);
    CHECK(back.notes[0].find("is not used: joint j1 follows this one") != std::string::npos);
}

TEST_CASE(
    "A plugin of Gazebo whose direction is unknown ties no joint, and is reported where nothing else does") {
    const std::string tie = "<joint>j1</joint><mimicJoint>j2</mimicJoint>";
    const std::string other =
        "<gazebo><plugin filename='libgazebo_mimic_joint_plugin.so'>" + tie + "</plugin></gazebo>";
    const ArmModel untied = loadUrdf(controlledChain(other));
    CHECK_FALSE(untied.joints.at(1).mimic);
    CHECK(untied.notes == std::vector<std::string>{
                              "joint j2: its tie to j1 in a plugin of <gazebo> is not used: the file does "
                              "not say which one follows"});
    CHECK(loadUrdf(controlledChain(other, mimicText("j1"))).notes.empty());
    const ArmModel named =
        loadUrdf(controlledChain("<gazebo><plugin filename='libcob_gazebo_mimic.so'><jointName>j2</jointName>"
                                 "<mimicJoint>j1</mimicJoint><multiplier>2</multiplier></plugin></gazebo>"));
    REQUIRE(named.joints.at(1).mimic);
    CHECK(named.joints[1].mimic->multiplier == 2.0);
}

TEST_CASE("Mimics of ros2_control and Gazebo that cannot be used are reported, and the robot is read") {
    CHECK(loadUrdf(controlledChain(pluginText("none", "j2"))).notes ==
          std::vector<std::string>{
              "joint j2: its mimic in a plugin of <gazebo> is not used: the robot has no joint none"});
    const auto circle = loadUrdf(controlledChain(pluginText("j1", "j2") + pluginText("j2", "j1"))).notes;
    REQUIRE(circle.size() == 2);
    CHECK(circle[1].find("is not used: joint j2 follows this one") != std::string::npos);
    CHECK(
        loadUrdf(controlledChain(controlText("j2", paramText("mimic", "j1") + paramText("multiplier", "x"))))
            .notes == std::vector<std::string>{
                          "joint j2: its mimic in <ros2_control> is not used: 'x' is no finite number"});
    CHECK(loadUrdf(controlledChain(pluginText("j1", "j9"))).notes ==
          std::vector<std::string>{
              "joint j9: its mimic in a plugin of <gazebo> is not used: the robot has no such joint"});
    CHECK(loadUrdf(controlledChain(controlText("j2", paramText("mimic", "${prefix}j1")))).notes ==
          std::vector<std::string>{"joint j2: its mimic in <ros2_control> is not expanded and not read"});
    CHECK(loadUrdf(controlledChain("<gazebo><plugin filename='p'><joint>j1</joint></plugin></gazebo>"))
              .notes.empty());
}

TEST_CASE("Narrower limits of a command interface are reported as not read") {
    const auto notes = [](const std::string& interface, const std::string& min, const std::string& max) {
        const std::string limits = "<command_interface name='" + interface + "'>" + paramText("min", min) +
                                   paramText("max", max) + "</command_interface>";
        return loadUrdf(controlledChain(controlText("j2", limits))).notes;
    };
    const std::vector<std::string> one{
        "joint j2: the narrower limits of <command_interface> are not read; arm.joints sets limits"};
    CHECK(notes("position", "-0.5", "0.5") == one);
    CHECK(notes("position", "-2", "1") == one);
    CHECK(notes("position", "-1.999", "2").empty()); // rounded
    CHECK(notes("position", "-2", "3").empty());
    CHECK(notes("position", "{-pi}", "{pi}").empty());
    CHECK(notes("velocity", "-0.5", "0.5").empty());
}
