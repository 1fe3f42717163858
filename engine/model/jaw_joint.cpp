// SPDX-License-Identifier: Apache-2.0
#include "engine/model/jaw_joint.h"

#include "engine/model/urdf_file.h"
#include "engine/types/number_text.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace fathom {

namespace {

constexpr double kJawTravel = 0.1, kJawTurn = 2.0; // [m], [rad] largest of a jaw
constexpr double kArmTravel = 0.2, kArmTurn = 0.5; // [m], [rad] a jaw has no longer slide, nor turns more to
                                                   // both sides
constexpr double kAcross = 0.5;                    // largest cosine of directions across each other
constexpr double kSameSpot = 1e-3;                 // [m] too near for a direction

bool movesToOneSide(const urdf::Joint& joint, double most) {
    if (!joint.limits) {
        return false;
    }
    const double low = joint.limits->lower, high = joint.limits->upper, range = high - low;
    return range > 0.0 && range <= most && std::min(std::abs(low), std::abs(high)) <= 0.1 * range;
}

bool turns(const urdf::Joint& joint) {
    return joint.type == urdf::Joint::REVOLUTE || joint.type == urdf::Joint::CONTINUOUS;
}

dvec3 axisOf(const urdf::Joint& joint) {
    const dvec3 axis(joint.axis.x, joint.axis.y, joint.axis.z);
    return glm::length(axis) > 0.0 ? glm::normalize(axis) : dvec3(1.0, 0.0, 0.0);
}

} // namespace

bool slidesLikeJaw(const urdf::ModelInterface& model, const urdf::Joint& joint, const urdf::Joint* last) {
    if (joint.type != urdf::Joint::PRISMATIC || !movesToOneSide(joint, kJawTravel) || last == nullptr ||
        !turns(*last)) {
        return false;
    }
    Pose lastTjoint = poseOf(joint.parent_to_joint_origin_transform);
    for (auto link = model.getLink(joint.parent_link_name); link->name != last->child_link_name;
         link = link->getParent()) {
        lastTjoint = poseOf(link->parent_joint->parent_to_joint_origin_transform) * lastTjoint;
    }
    const dvec3 slide = lastTjoint.rotation * axisOf(joint), way = lastTjoint.position;
    return std::abs(glm::dot(slide, axisOf(*last))) <= kAcross &&
           (glm::length(way) < kSameSpot || std::abs(glm::dot(slide, way)) <= kAcross * glm::length(way));
}

bool movesAsArm(const urdf::Joint& joint, const JointWords& words, int behind) {
    if (joint.type == urdf::Joint::CONTINUOUS || turnsHand(words)) {
        return true;
    }
    const double low = joint.limits ? joint.limits->lower : 0.0,
                 high = joint.limits ? joint.limits->upper : 0.0;
    return joint.type == urdf::Joint::PRISMATIC
               ? high - low > kArmTravel
               : std::min(-low, high) > kArmTurn && !closesGripper(words, behind);
}

std::string jawWarning(const urdf::Joint& joint, const std::string& holder) {
    const bool slide = joint.type == urdf::Joint::PRISMATIC;
    if (!(slide || joint.type == urdf::Joint::REVOLUTE) ||
        !movesToOneSide(joint, slide ? kJawTravel : kJawTurn)) {
        return "";
    }
    return "joint " + joint.name + " (" + significant(joint.limits->lower, 3) + " to " +
           significant(joint.limits->upper, 3) + (slide ? " m" : " rad") +
           ") is the last of the chain and may close a gripper; if so, set arm.tip to " + holder;
}

} // namespace fathom
