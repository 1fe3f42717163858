// SPDX-License-Identifier: Apache-2.0
#include "engine/reader/mjcf_pose.h"

#include <cmath>

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

// The form of the turn that applies: the element's own, of any form, replaces that of its class. Empty =
// none.
std::string turnForm(const MjcfClasses& classes, const tinyxml2::XMLElement& element,
                     const std::string& childClass) {
    std::string own, inherited;
    for (const char* form : {"quat", "axisangle", "euler", "xyaxes", "zaxis"}) {
        if (element.Attribute(form) != nullptr) {
            if (!own.empty()) {
                classes.refuse(element, own + " and " + form,
                               "one of quat, axisangle, euler, xyaxes and zaxis");
            }
            own = form;
        } else if (inherited.empty() && classes.find(element, childClass, form) != nullptr) {
            inherited = form;
        }
    }
    return own.empty() ? inherited : own;
}

dquat turnOf(const MjcfClasses& classes, const MjcfAngles& angles, const tinyxml2::XMLElement& element,
             const std::string& form, const std::vector<double>& v) {
    if (form == "quat") {
        const dquat quat(v[0], v[1], v[2], v[3]);
        if (!(glm::length(quat) > kShortest)) {
            classes.refuse(element, "quat of length 0", "a unit quaternion w x y z");
        }
        return glm::normalize(quat);
    }
    if (form == "euler") {
        return ofEuler(angles, v);
    }
    const dvec3 first = direction(classes, element, {v[0], v[1], v[2]}, form.c_str());
    if (form == "axisangle") {
        return turn(first, v[3] * angles.perUnit);
    }
    if (form == "zaxis") {
        return turnOfZ(first);
    }
    const dvec3 given(v[3], v[4], v[5]);
    const dvec3 y = direction(classes, element, given - first * glm::dot(first, given), "xyaxes");
    return glm::normalize(glm::quat_cast(glm::dmat3(first, y, glm::cross(first, y))));
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
    const std::string form = turnForm(classes, element, childClass);
    if (!form.empty()) {
        const size_t count = form == "xyaxes" ? 6 : form == "quat" || form == "axisangle" ? 4 : 3;
        out.rotation = turnOf(classes, angles, element, form, numbers(form.c_str(), count));
    }
    return out;
}

MjcfShapePose mjcfShapePose(const MjcfClasses& classes, const MjcfAngles& angles,
                            const tinyxml2::XMLElement& element, const std::string& childClass) {
    const auto ends = classes.numbers(element, childClass, "fromto", {}, 6, 6);
    if (ends.empty()) {
        return {mjcfPose(classes, angles, element, childClass), std::nullopt};
    }
    const dvec3 from(ends[0], ends[1], ends[2]), to(ends[3], ends[4], ends[5]);
    const double half = 0.5 * glm::distance(from, to);
    if (!(half > kShortest)) {
        classes.refuse(element, "fromto of length 0", "two points");
    }
    return {{0.5 * (from + to), turnOfZ(from - to)}, half};
}

} // namespace fathom
