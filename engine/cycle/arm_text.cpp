// SPDX-License-Identifier: Apache-2.0
#include "engine/cycle/arm_text.h"

#include <cmath>
#include <sstream>

namespace fathom {

namespace {

std::string mimicText(const ArmModel& model, const ArmMimic& mimic) {
    std::ostringstream out;
    const double gain = mimic.multiplier;
    if (mimic.offset != 0.0) {
        out << mimic.offset << (gain < 0.0 ? " - " : " + ");
    } else {
        out << (gain < 0.0 ? "-" : "");
    }
    if (std::abs(gain) != 1.0) {
        out << std::abs(gain) << " ";
    }
    out << model.joints[mimic.joint].name;
    return out.str();
}

std::string jointText(const ArmModel& model, const ArmJoint& joint, double start) {
    std::ostringstream out;
    const std::string unit = joint.slides ? "m" : "rad";
    out << "joint " << joint.name << ": " << (joint.slides ? "prismatic, " : "revolute, ");
    if (std::isinf(joint.lower) && std::isinf(joint.upper)) {
        out << "without limits";
    } else {
        out << joint.lower << " to " << joint.upper << " " << unit;
    }
    out << " (" << joint.limitsFrom << "), ";
    if (joint.mimic) {
        out << "equals " << mimicText(model, *joint.mimic) << " (mimic)";
    } else {
        out << joint.speed << " " << unit << "/s (" << joint.speedFrom << "), starts at " << start;
    }
    return out.str();
}

std::string fingerText(const ArmModel& model, const ArmFinger& finger) {
    std::ostringstream out;
    out << "finger " << finger.name << ": ";
    if (finger.mimic) {
        out << "equals " << mimicText(model, *finger.mimic) << " (mimic)";
    } else {
        out << "open " << finger.open << ", closed " << finger.closed << (finger.slides ? " m" : " rad");
    }
    return out.str();
}

} // namespace

std::vector<std::string> describeArm(const ArmSetup& setup) {
    const ArmModel& model = setup.model;
    std::vector<std::string> lines{"base " + model.baseText + ", at base_T_arm", "tip " + model.tipText};
    for (size_t k = 0; k < model.count(); ++k) {
        lines.push_back(jointText(model, model.joints[k], setup.start[k]));
    }
    for (const ArmFinger& finger : model.fingers) {
        lines.push_back(fingerText(model, finger));
    }
    for (const std::string& joint : model.held) {
        lines.push_back("joint " + joint);
    }
    return lines;
}

} // namespace fathom
