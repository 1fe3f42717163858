// SPDX-License-Identifier: Apache-2.0
#include "engine/reader/mjcf_pose.h"

#include <cmath>
#include <optional>

namespace fathom {

namespace {

constexpr double kShortest = 1e-10; // of a direction

dquat turn(const dvec3& axis, double angle) {
    return glm::angleAxis(angle, glm::normalize(axis));
}

dvec3 direction(const MjcfClasses& classes, const tinyxml2::XMLElement& element, const dvec3& v,
                const char* name) {
    if (!(glm::length(v) > kShortest)) {
        classes.refuse(element, std::string(name) + " of length 0", "a direction");
    }
    return glm::normalize(v);
}

dquat ofEuler(const MjcfAngles& angles, const std::vector<double>& by) {
    dquat all(1.0, 0.0, 0.0, 0.0);
    for (size_t i = 0; i < 3; ++i) {
        const char axis = angles.eulerOrder[i];
        const bool along = axis >= 'a';
        dvec3 unit(0.0);
        unit[(along ? axis - 'x' : axis - 'X')] = 1.0;
        const dquat next = turn(unit, by[i] * angles.perUnit);
        all = along ? all * next : next * all;
    }
    return all;
}

} // namespace

MjcfAngles mjcfAngles(const MjcfClasses& classes, const tinyxml2::XMLElement& root) {
    MjcfAngles out;
    for (auto* compiler = root.FirstChildElement("compiler"); compiler != nullptr;
         compiler = compiler->NextSiblingElement("compiler")) {
        const std::string angle = compiler->Attribute("angle") != nullptr ? compiler->Attribute("angle") : "";
        if (angle == "radian") {
            out.perUnit = 1.0;
        } else if (angle == "degree") {
            out.perUnit = MjcfAngles{}.perUnit;
        } else if (!angle.empty()) {
            classes.refuse(*compiler, "angle=\"" + angle + "\"", "degree or radian");
        }
        if (const char* order = compiler->Attribute("eulerseq")) {
            out.eulerOrder = order;
            if (out.eulerOrder.size() != 3 ||
                out.eulerOrder.find_first_not_of("xyzXYZ") != std::string::npos) {
                classes.refuse(*compiler, "eulerseq=\"" + out.eulerOrder + "\"", "three of xyzXYZ");
            }
        }
        const char* const coordinate = compiler->Attribute("coordinate");
        if (coordinate != nullptr && std::string(coordinate) != "local") {
            classes.refuse(*compiler, "coordinate=\"" + std::string(coordinate) + "\"", "local");
        }
    }
    return out;
}

dquat turnOfZ(const dvec3& direction) {
    const dvec3 z(0.0, 0.0, 1.0), to = glm::normalize(direction);
    const dvec3 axis = glm::cross(z, to);
    const double sine = glm::length(axis), cosine = glm::dot(z, to);
    if (sine < kShortest) {
        return cosine > 0.0 ? dquat(1.0, 0.0, 0.0, 0.0) : dquat(0.0, 1.0, 0.0, 0.0);
    }
    return turn(axis, std::atan2(sine, cosine));
}

Pose mjcfPose(const MjcfClasses& classes, const MjcfAngles& angles, const tinyxml2::XMLElement& element,
              const std::string& childClass) {
    const auto numbers = [&](const char* name, size_t count) {
        return classes.numbers(element, childClass, name, {}, count, count);
    };
    Pose out;
    if (const auto p = numbers("pos", 3); !p.empty()) {
        out.position = {p[0], p[1], p[2]};
    }
    if (const auto q = numbers("quat", 4); !q.empty()) {
        const dquat quat(q[0], q[1], q[2], q[3]);
        if (!(glm::length(quat) > kShortest)) {
            classes.refuse(element, "quat of length 0", "a unit quaternion w x y z");
        }
        out.rotation = glm::normalize(quat);
    } else if (const auto a = numbers("axisangle", 4); !a.empty()) {
        out.rotation =
            turn(direction(classes, element, {a[0], a[1], a[2]}, "axisangle"), a[3] * angles.perUnit);
    } else if (const auto e = numbers("euler", 3); !e.empty()) {
        out.rotation = ofEuler(angles, e);
    } else if (const auto xy = numbers("xyaxes", 6); !xy.empty()) {
        const dvec3 x = direction(classes, element, {xy[0], xy[1], xy[2]}, "xyaxes");
        const dvec3 given(xy[3], xy[4], xy[5]);
        const dvec3 y = direction(classes, element, given - x * glm::dot(x, given), "xyaxes");
        out.rotation = glm::normalize(glm::quat_cast(glm::dmat3(x, y, glm::cross(x, y))));
    } else if (const auto z = numbers("zaxis", 3); !z.empty()) {
        out.rotation = turnOfZ(direction(classes, element, {z[0], z[1], z[2]}, "zaxis"));
    }
    return out;
}

} // namespace fathom
