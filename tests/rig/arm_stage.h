// SPDX-License-Identifier: Apache-2.0
// A scene with an arm in front of a wall, for a simulated arm on a serial line.
#pragma once

#include "tests/rig/arm_bench.h"
#include "tests/rig/stage.h"

#include <array>
#include <cmath>
#include <string>
#include <vector>

namespace fathom::testing {

inline constexpr double kLink = 0.2;                  // [m]
inline constexpr double kStart[3] = {-0.9, 0.8, 0.4}; // [rad]
inline constexpr const char* kReach =
    "protocol: reach_alpha5, axes: [{axis: base, joint: slew, sign: -1, zero: 0.1}, "
    "{axis: shoulder, joint: shoulder}, {axis: elbow, joint: elbow, zero: -0.2}]";
inline constexpr const char* kEca =
    "protocol: eca_5e, axes: [{axis: slew, joint: slew, sign: -1, zero: -0.9}, "
    "{axis: shoulder, joint: shoulder, zero: 0.8}, {axis: elbow, joint: elbow, zero: 0.4}]";

// Three links in the plane of the camera's axis, with a ball on each joint and on the tip.
inline std::string urdf() {
    const std::string ball = "<collision><geometry><sphere radius='0.02'/></geometry></collision></link>";
    const auto joint = [](const char* name, const char* parent, const char* child, double x) {
        return std::string("<joint name='") + name + "' type='revolute'><parent link='" + parent +
               "'/><child link='" + child + "'/><origin xyz='" + std::to_string(x) +
               " 0 0'/><axis xyz='0 0 1'/><limit effort='1' velocity='0.4' lower='-2' upper='2'/></joint>";
    };
    return "<robot name='r'><link name='base'>" + ball + "<link name='one'>" + ball + "<link name='two'>" +
           ball + "<link name='three'>" + ball + "<link name='tip'>" + ball +
           joint("slew", "base", "one", 0.0) + joint("shoulder", "one", "two", kLink) +
           joint("elbow", "two", "three", kLink) +
           "<joint name='end' type='fixed'><parent link='three'/><child link='tip'/><origin xyz='0.2 0 "
           "0'/></joint>"
           "</robot>";
}

// A wall 0.6 m away with a region of 40 mm. The arm is next to the camera, its tip 0.12 m in front of the
// region.
inline void setUp(const Stage& stage, const std::string& driver, const std::vector<HandRow>& hand) {
    stage.recording({Image(kWidth, kHeight, 600).paint({0, 0, kWidth, kHeight}, kRed)});
    stage.scene({});
    stage.hand(hand);
    stage.write("arm.urdf", urdf());
    stage.write("scene.yaml",
                stage.read("scene.yaml") +
                    "arm:\n  urdf: arm.urdf\n  tip: tip\n  base_T_arm: {xyz: [-0.4, 0, 0.3], quat_xyzw: "
                    "[-0.7071067811865476, 0, 0, 0.7071067811865476]}\n  direction: free\n  driver: {" +
                    driver + "}\n");
}

// Moves towards the wall until the tip would be 57 mm inside its region.
inline std::vector<HandRow> pushing(double seconds) {
    return {{0.0, {0, 0, 0}}, {0.3, {0, 0, 0}}, {2.8, {0, 0, 0.18}}, {seconds, {0, 0, 0.18}}};
}

inline double tipDepth(const std::array<double, 3>& q) { // [m] z in the base frame
    double angle = 0.0, y = 0.0;
    for (double joint : q) {
        angle += joint;
        y += kLink * std::sin(angle);
    }
    return 0.3 - y;
}

inline std::array<double, 3> jointsOf(const ReachSimulator& arm) {
    return {0.1 - arm.position[5], arm.position[4], arm.position[3] - 0.2};
}

inline void setStart(ReachSimulator& arm) {
    arm.position = {0, 7.0, 0.3, kStart[2] + 0.2, kStart[1], 0.1 - kStart[0]};
}

} // namespace fathom::testing
