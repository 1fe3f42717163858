// SPDX-License-Identifier: Apache-2.0
#include "engine/model/bare_frames.h"

#include "engine/model/gripper_joints.h"
#include "engine/model/link_names.h"
#include "engine/model/urdf_file.h"
#include "engine/types/lower_case.h"

#include <algorithm>
#include <array>
#include <utility>

namespace fathom {

namespace {

using FramePtr = std::shared_ptr<const urdf::Link>;

bool isBareFrame(const urdf::Link& link) {
    return link.collision_array.empty() && link.visual_array.empty() && !link.inertial;
}

// False for the places of sensors and tendons, and for names that no file states (two underscores).
bool mayBeTool(const std::string& name) {
    constexpr std::array kOthers{"__",      "camera", "force",  "imu",   "lidar",
                                 "optical", "sensor", "tendon", "torque"};
    const std::string lower = lowerCase(name);
    return std::ranges::none_of(kOthers,
                                [&](const char* word) { return lower.find(word) != std::string::npos; });
}

} // namespace

FramePtr bodyAt(const urdf::ModelInterface& model, const FramePtr& link) {
    if (isBareFrame(*link) && link->parent_joint && moves(*link->parent_joint) &&
        link->child_joints.size() == 1 && link->child_joints[0]->type == urdf::Joint::FIXED) {
        const FramePtr child = model.getLink(link->child_joints[0]->child_link_name);
        return isBareFrame(*child) ? link : child;
    }
    return link;
}

FramePtr bareEnd(const urdf::ModelInterface& model, const GripperJoints& grippers, FramePtr link) {
    for (;;) {
        std::vector<FramePtr> bare;
        for (const auto& joint : link->child_joints) {
            const FramePtr child = model.getLink(joint->child_link_name);
            const bool site = joint->name.ends_with(kSiteEnding); // of a sensor or tendon, by its name
            if (joint->type == urdf::Joint::FIXED && isBareFrame(*child) && !site &&
                grippers.depthBelow(child->name) == 0) {
                bare.push_back(child);
            }
        }
        if (bare.size() != 1) {
            return link;
        }
        link = bare[0];
    }
}

std::vector<std::string> framesBelow(const urdf::ModelInterface& model, const FramePtr& tip) {
    std::vector<std::string> names;
    std::vector<std::pair<FramePtr, Pose>> open{{tip, Pose{}}};
    for (size_t at = 0; at < open.size(); ++at) {
        const auto [link, tipTlink] = open[at];
        const bool apart = tipTlink.position != dvec3(0.0) || tipTlink.rotation != dquat(1.0, 0.0, 0.0, 0.0);
        if (apart && isBareFrame(*link) && mayBeTool(link->name)) {
            names.push_back(link->name);
        }
        for (const auto& joint : link->child_joints) {
            if (joint->type == urdf::Joint::FIXED) {
                open.emplace_back(model.getLink(joint->child_link_name),
                                  tipTlink * poseOf(joint->parent_to_joint_origin_transform));
            }
        }
    }
    return names;
}

bool standsApart(const urdf::Link& base) {
    const urdf::Joint* joint = base.parent_joint.get();
    for (FramePtr link = base.getParent(); joint != nullptr; link = link->getParent()) {
        const Pose place = poseOf(joint->parent_to_joint_origin_transform);
        if (joint->type != urdf::Joint::FIXED || place.position != dvec3(0.0) ||
            place.rotation != dquat(1.0, 0.0, 0.0, 0.0)) {
            return true;
        }
        joint = link->parent_joint.get();
    }
    return false;
}

bool isAbove(const urdf::Link& link, std::shared_ptr<const urdf::Link> below) {
    while (below && below.get() != &link) {
        below = below->getParent();
    }
    return below != nullptr;
}

void lowerBase(const urdf::ModelInterface& model, ArmEnds& ends) {
    bool any = false;
    for (std::shared_ptr<const urdf::Link> link = ends.tip; link && link != ends.base;
         link = link->getParent()) {
        if (link->parent_joint && !isFree(*link->parent_joint)) {
            any = any || moves(*link->parent_joint);
        } else if (link->parent_joint && any) {
            ends.base = model.getLink(link->name);
            ends.baseWhy = "below the planar or floating joint " + link->parent_joint->name;
            return;
        }
    }
}

} // namespace fathom
