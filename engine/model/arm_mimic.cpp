// SPDX-License-Identifier: Apache-2.0
#include "engine/model/arm_mimic.h"

#include "engine/types/error.h"
#include "engine/types/number_text.h"

#include <algorithm>
#include <cmath>

namespace fathom {

namespace {

JointTie tieOf(const urdf::ModelInterface& model, const std::filesystem::path& file,
               const urdf::Joint& joint) {
    JointTie tie{joint.name, 1.0, 0.0};
    const auto refuse = [&](const std::string& value, const std::string& allowed) {
        throw BadInput(file.string(), "joint " + joint.name + ", mimic", value, allowed);
    };
    const urdf::Joint* at = &joint;
    for (size_t steps = 0; at->mimic && at->type != urdf::Joint::FIXED; ++steps) {
        const urdf::JointMimic& mimic = *at->mimic;
        if (!std::isfinite(mimic.multiplier) || !std::isfinite(mimic.offset)) {
            refuse("multiplier " + significant(mimic.multiplier, 6) + ", offset " +
                       significant(mimic.offset, 6),
                   "finite numbers");
        }
        const auto next = model.joints_.find(mimic.joint_name);
        if (next == model.joints_.end()) {
            refuse("'" + excerpt(mimic.joint_name) + "'", "a joint of the robot");
        }
        if (steps == model.joints_.size()) {
            refuse("'" + excerpt(mimic.joint_name) + "'",
                   "a joint that does not follow this one, directly or through others");
        }
        tie = {mimic.joint_name, tie.multiplier * mimic.multiplier,
               tie.offset + tie.multiplier * mimic.offset};
        at = next->second.get();
    }
    return tie;
}

// The values of the followed joint at which its mimic joint is at `lower` and `upper`.
std::pair<double, double> seenFrom(const ArmMimic& mimic, double lower, double upper) {
    return std::minmax((lower - mimic.offset) / mimic.multiplier, (upper - mimic.offset) / mimic.multiplier);
}

class Narrower {
public:
    explicit Narrower(ArmModel& model)
        : model_(model) {}

    void add(const std::string& name, const ArmMimic& mimic, double lower, double upper) {
        ArmJoint& joint = model_.joints[mimic.joint];
        const auto [low, high] = seenFrom(mimic, lower, upper);
        if (low > joint.upper || high < joint.lower) {
            notes_.push_back("joint " + name + ": its limits leave no value for joint " + joint.name +
                             ", which it follows, and are ignored");
            return;
        }
        if (low > joint.lower || high < joint.upper) {
            joint.lower = std::max(joint.lower, low);
            joint.upper = std::min(joint.upper, high);
            joint.limitsFrom = "mimic joint " + name;
        }
    }
    void slow(const std::string& name, const ArmMimic& mimic, double speed) {
        ArmJoint& joint = model_.joints[mimic.joint];
        if (speed / std::abs(mimic.multiplier) < joint.speed) {
            joint.speed = speed / std::abs(mimic.multiplier);
            joint.speedFrom = "mimic joint " + name;
        }
    }
    std::vector<std::string> takeNotes() { return std::move(notes_); }

private:
    ArmModel& model_;
    std::vector<std::string> notes_;
};

} // namespace

std::map<std::string, JointTie> tieJoints(const urdf::ModelInterface& model,
                                          const std::filesystem::path& file) {
    std::map<std::string, JointTie> ties;
    for (const auto& [name, joint] : model.joints_) {
        ties[name] = tieOf(model, file, *joint);
    }
    return ties;
}

std::vector<std::string> narrowByMimics(ArmModel& model) {
    Narrower narrower(model);
    for (const ArmJoint& joint : model.joints) {
        if (joint.mimic) {
            narrower.add(joint.name, *joint.mimic, joint.lower, joint.upper);
            if (joint.speedFrom != kDefaultSpeedSource) {
                narrower.slow(joint.name, *joint.mimic, joint.speed);
            }
        }
    }
    for (const ArmFinger& finger : model.fingers) {
        if (finger.mimic) {
            narrower.add(finger.name, *finger.mimic, finger.lower, finger.upper);
            narrower.slow(finger.name, *finger.mimic, finger.speed);
        }
    }
    return narrower.takeNotes();
}

} // namespace fathom
