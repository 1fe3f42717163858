// SPDX-License-Identifier: Apache-2.0
// URDF to ArmModel.
#include "engine/model/arm_ends.h"
#include "engine/model/arm_mimic.h"
#include "engine/model/arm_model.h"
#include "engine/model/arm_shapes.h"
#include "engine/model/arm_warnings.h"
#include "engine/model/finger_ends.h"
#include "engine/model/joint_drives.h"
#include "engine/model/link_names.h"
#include "engine/model/urdf_file.h"
#include "engine/types/error.h"

#include <algorithm>
#include <limits>
#include <sstream>

namespace fathom {

namespace {

constexpr double kMaxSpeed = 100.0; // [rad/s], [m/s] a higher value counts as unlimited

class Loader {
public:
    Loader(const std::filesystem::path& file, const ArmOptions& options)
        : file_(file)
        , options_(options)
        , urdf_(readUrdf(file, options.reader)) {}

    ArmModel load() {
        const ArmEnds ends = chooseEnds(*urdf_, file_, options_.base, options_.tip);
        model_.baseText = ends.base->name + " (" + ends.baseWhy + ")";
        model_.tipText = ends.tip->name + " (" + ends.tipWhy + ")";
        model_.notes = urdf_->notes;
        model_.notes.insert(model_.notes.end(), ends.notes.begin(), ends.notes.end());
        const auto chain = chainTo(ends.tip, ends.base);
        drives_ = driveJoints(*urdf_, file_, options_, chain);
        addChain(chain);
        addLinks(ends.base, Pose{}, {0, 0});
        addAbove(ends.base);
        checkFingers();
        shapes_.cover(file_, options_, model_);
        if (model_.leaves.empty()) {
            refuse("collision", "no shapes on any link", "links with collision geometry");
        }
        for (const std::string& line : chooseFingerEnds(model_, options_, tieJoints(*urdf_, file_))) {
            note(line);
        }
        for (const std::string& line : narrowByMimics(model_)) {
            note(line);
        }
        return std::move(model_);
    }

private:
    using LinkPtr = std::shared_ptr<const urdf::Link>;
    using JointPtr = std::shared_ptr<const urdf::Joint>;

    [[noreturn]] void refuse(const std::string& field, const std::string& value,
                             const std::string& allowed) const {
        throw BadInput(file_.string(), field, value, allowed);
    }

    std::vector<JointPtr> chainTo(const LinkPtr& tip, const LinkPtr& base) const {
        std::vector<JointPtr> chain;
        for (LinkPtr link = tip; link != base; link = urdf_->getLink(chain.back()->parent_link_name)) {
            if (!link->parent_joint) {
                refuse("tip", "'" + tip->name + "'", "a link carried by '" + base->name + "'");
            }
            chain.push_back(link->parent_joint);
        }
        std::reverse(chain.begin(), chain.end());
        return chain;
    }

    using Kind = JointDrive::Kind;

    void addChain(const std::vector<JointPtr>& chain) {
        Pose before;
        for (const auto& joint : chain) {
            before = before * poseOf(joint->parent_to_joint_origin_transform);
            if (joint->type == urdf::Joint::FIXED) {
                continue;
            }
            const JointDrive& drive = drives_.at(joint->name);
            if (!hasAxis(*joint)) {
                refuse("joint " + joint->name, "planar, floating or a ball",
                       "revolute, continuous, prismatic or fixed; arm.base starts below it, or arm.tip ends "
                       "above it");
            }
            if (drive.kind == Kind::Held) {
                before = before * hold(*joint, drive);
                continue;
            }
            add(*joint, before, drive);
            before = Pose{};
        }
        model_.lastTtip = before;
    }

    Pose hold(const urdf::Joint& joint, const JointDrive& drive) {
        std::ostringstream line;
        line << joint.name << " stays at " << drive.value << " (" << drive.why << ")";
        if (std::find(model_.held.begin(), model_.held.end(), line.str()) == model_.held.end()) {
            model_.held.push_back(line.str());
            note(heldWarning(joint.name, joint.type == urdf::Joint::PRISMATIC, drive.value));
            if (joint.limits && joint.type != urdf::Joint::CONTINUOUS && hasAxis(joint)) {
                note(beyondWarning(joint.name, drive.value, joint.limits->lower, joint.limits->upper));
            }
        }
        return drive.value == 0.0 || !hasAxis(joint) ? Pose{} : motionOf(joint, drive.value);
    }

    dvec3 axisOf(const urdf::Joint& joint) const {
        const dvec3 axis(joint.axis.x, joint.axis.y, joint.axis.z);
        if (!(glm::length(axis) > 1e-9)) {
            refuse("joint " + joint.name, "axis of no length", "a direction");
        }
        return glm::normalize(axis);
    }

    void checkRoom(const urdf::Joint& joint) const {
        if (model_.joints.size() == kMaxJoints) {
            refuse("joint " + joint.name, "one more moving joint",
                   std::to_string(kMaxJoints) +
                       " at most from base to tip; arm.locked holds joints, arm.base and arm.tip shorten the "
                       "chain" +
                       tipAdvice(*urdf_, joint, kMaxJoints));
        }
    }

    void add(const urdf::Joint& joint, const Pose& before, const JointDrive& drive) {
        checkRoom(joint);
        const bool slides = joint.type == urdf::Joint::PRISMATIC;
        constexpr double kAny = std::numeric_limits<double>::infinity();
        ArmJoint out{joint.name, slides, before, axisOf(joint), -kAny, kAny, 0.0};
        setSpeed(joint, out);
        if (joint.type == urdf::Joint::CONTINUOUS) {
            out.limitsFrom = "continuous";
        } else {
            if (const std::string fault = limitFault(joint.limits.get()); !fault.empty()) {
                refuse("joint " + joint.name, fault, "lower <= upper");
            }
            out.lower = joint.limits->lower;
            out.upper = joint.limits->upper;
        }
        if (drive.kind == Kind::Follows) {
            out.mimic = drive.mimic;
        } else {
            note(limitWarning(out.name, slides, out.lower, out.upper, kLongSlide));
        }
        note(speedWarning(out.name, slides, joint.limits ? joint.limits->velocity : 0.0));
        model_.joints.push_back(out);
        moving_.push_back(joint.name);
    }

    void note(const std::string& warning) {
        if (!warning.empty()) {
            model_.notes.push_back(warning);
        }
    }

    static void setSpeed(const urdf::Joint& joint, ArmJoint& out) {
        const double stated = joint.limits ? joint.limits->velocity : 0.0;
        if (stated > 0.0) {
            out.speed = std::min(stated, kMaxSpeed);
            out.speedFrom = stated > kMaxSpeed ? "file, but at most this" : out.speedFrom;
        } else {
            out.speed = out.slides ? kUnknownSlide : kUnknownTurn;
            out.speedFrom = kDefaultSpeedSource;
        }
    }

    // Shapes of `link` and of its descendants but those through `skip`, in the frame of the joint that
    // carries them.
    void addLinks(const LinkPtr& link, const Pose& frameTlink, const LinkCarrier& carrier,
                  const urdf::Joint* skip = nullptr) {
        shapes_.add(*link, frameTlink, carrier);
        if (link->collision_array.empty() &&
            (!link->visual_array.empty() || link->inertial)) { // else it is only a frame
            model_.notes.push_back("link " + link->name + " has no collision shape and can enter regions");
        }
        for (const auto& below : link->child_joints) {
            if (below.get() == skip) {
                continue;
            }
            const LinkPtr child = urdf_->getLink(below->child_link_name);
            const auto chained = std::find(moving_.begin(), moving_.end(), below->name);
            const Pose place = frameTlink * poseOf(below->parent_to_joint_origin_transform);
            if (chained != moving_.end()) {
                addLinks(child, Pose{}, {static_cast<uint32_t>(chained - moving_.begin()) + 1, 0});
            } else if (below->type == urdf::Joint::FIXED) {
                addLinks(child, place, carrier);
            } else {
                addMoving(*below, child, place, carrier);
            }
        }
    }

    void addMoving(const urdf::Joint& joint, const LinkPtr& child, const Pose& place,
                   const LinkCarrier& carrier) {
        const JointDrive& drive = drives_.at(joint.name);
        if (drive.kind == Kind::Held) {
            if (!hasAxis(joint)) {
                model_.notes.push_back("link " + child->name + " is only guarded where joint " + joint.name +
                                       ", which is planar, floating or a ball, is 0");
            }
            addLinks(child, place * hold(joint, drive), carrier);
            return;
        }
        addFinger(joint, drive, place, carrier);
        addLinks(child, Pose{}, {carrier.joint, static_cast<uint32_t>(model_.fingers.size())});
    }

    void addFinger(const urdf::Joint& joint, const JointDrive& drive, const Pose& before,
                   const LinkCarrier& carrier) {
        if (model_.fingers.size() == kMaxFingers) {
            refuse("joint " + joint.name, "one more finger", std::to_string(kMaxFingers) + " at most");
        }
        ArmFinger finger{joint.name,  carrier.joint, joint.type == urdf::Joint::PRISMATIC,
                         before,      axisOf(joint), drive.open,
                         drive.closed};
        finger.carrier = carrier.finger;
        if (joint.limits && joint.limits->velocity > 0.0) {
            finger.speed = joint.limits->velocity;
        }
        if (joint.limits && joint.type != urdf::Joint::CONTINUOUS) {
            finger.lower = joint.limits->lower;
            finger.upper = joint.limits->upper;
        }
        if (drive.kind == Kind::Follows) {
            finger.mimic = drive.mimic;
        } else if (joint.mimic) { // what it follows decides
            note(takenWarning(finger.name, drive.open, drive.closed, finger.lower, finger.upper));
            finger.lower = std::min({finger.lower, drive.open, drive.closed});
            finger.upper = std::max({finger.upper, drive.open, drive.closed});
        }
        if (drive.kind != Kind::Follows && drive.open != drive.closed) {
            note(limitWarning(finger.name, finger.slides, std::min(drive.open, drive.closed),
                              std::max(drive.open, drive.closed), kLongFinger));
        }
        model_.fingers.push_back(finger);
    }

    // The rest of the robot: links that carry the base, and other branches. It does not move relative to the
    // base.
    void addAbove(const LinkPtr& base) {
        Pose baseTlink;
        for (LinkPtr link = base; link->parent_joint;) {
            const urdf::Joint& joint = *link->parent_joint;
            const LinkPtr above = urdf_->getLink(joint.parent_link_name);
            if (joint.type != urdf::Joint::FIXED && !hasAxis(joint)) {
                noteUnguarded(*above, joint);
                return;
            }
            Pose linkTchild = poseOf(joint.parent_to_joint_origin_transform);
            if (joint.type != urdf::Joint::FIXED) {
                linkTchild = linkTchild * hold(joint, drives_.at(joint.name));
            }
            baseTlink = baseTlink * inverse(linkTchild);
            addLinks(above, baseTlink, {0, 0}, &joint);
            link = above;
        }
    }

    void checkFingers() {
        for (const auto& wanted : options_.fingers) {
            const auto same = [&](const ArmFinger& finger) { return finger.name == wanted.joint; };
            const auto found = std::find_if(model_.fingers.begin(), model_.fingers.end(), same);
            if (found == model_.fingers.end()) {
                refuse("finger", "'" + wanted.joint + "'", "a joint that the arm's base carries");
            }
        }
    }

    void noteUnguarded(const urdf::Link& above, const urdf::Joint& joint) {
        if (!above.collision_array.empty() || above.child_joints.size() > 1 || above.parent_joint) {
            model_.notes.push_back("link " + above.name + " and what hangs on it beside joint " + joint.name +
                                   ", which is planar or floating, is not guarded");
        }
    }

    std::filesystem::path file_;
    ArmOptions options_;
    std::shared_ptr<const UrdfModel> urdf_;
    ArmModel model_;
    std::map<std::string, JointDrive> drives_;
    std::vector<std::string> moving_; // of the chain
    ArmShapes shapes_;
};

} // namespace

ArmModel loadArm(const std::filesystem::path& urdf, const ArmOptions& options) {
    return Loader(urdf, options).load();
}

} // namespace fathom
