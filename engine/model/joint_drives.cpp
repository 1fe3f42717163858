// SPDX-License-Identifier: Apache-2.0
#include "engine/model/joint_drives.h"

#include "engine/model/arm_mimic.h"
#include "engine/model/grasp_ends.h"
#include "engine/types/error.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <sstream>

namespace fathom {

namespace {

constexpr double kAgree = 1e-6; // [rad], [m] tolerance between positions that the user wrote

std::string numberText(double value) {
    std::ostringstream out;
    out << value;
    return out.str();
}

class Driver {
public:
    using Chain = std::span<const std::shared_ptr<const urdf::Joint>>;

    Driver(const urdf::ModelInterface& model, const std::filesystem::path& file, const ArmOptions& options,
           Chain chain)
        : model_(model)
        , file_(file)
        , options_(options)
        , chain_(chain)
        , ties_(tieJoints(model, file)) {}

    std::map<std::string, JointDrive> all() {
        lock();
        for (const auto& finger : options_.fingers) {
            grasp(finger);
        }
        holdAbove();
        leadChain();
        std::map<std::string, JointDrive> drives;
        for (const auto& [name, joint] : model_.joints_) {
            if (joint->type != urdf::Joint::FIXED) {
                drives[name] = driveOf(*joint);
            }
        }
        return drives;
    }

private:
    struct Group {                      // joints tied to one root
        std::optional<double> held;     // value of the root
        std::string heldBy;             // joint
        std::optional<uint32_t> leader; // of the moving chain
        JointTie leaderTie;
        std::string finger; // first one named; empty = none
        double open = 0.0, closed = 0.0;
    };

    [[noreturn]] void refuse(const std::string& field, const std::string& value,
                             const std::string& allowed) const {
        throw BadInput(file_.string(), field, value, allowed);
    }

    Group& groupOf(const std::string& joint) { return groups_[ties_.at(joint).root]; }

    static std::string limitsText(const urdf::Joint& joint) {
        return numberText(joint.limits->lower) + " to " + numberText(joint.limits->upper);
    }

    bool onChain(const std::string& name) const {
        return std::any_of(chain_.begin(), chain_.end(), [&](const auto& j) { return j->name == name; });
    }

    void lock() {
        for (const auto& [name, value] : options_.locked) {
            const auto found = model_.joints_.find(name);
            if (found == model_.joints_.end() || !hasAxis(*found->second)) {
                refuse("locked", "'" + excerpt(name) + "'", "revolute, continuous or prismatic joints");
            }
            const urdf::Joint& joint = *found->second;
            const bool limited = joint.type != urdf::Joint::CONTINUOUS && joint.limits;
            if (limited && !(value >= joint.limits->lower && value <= joint.limits->upper)) {
                refuse("locked " + name, numberText(value), limitsText(joint) + ", the joint's limits");
            }
            const JointTie& tie = ties_.at(name);
            Group& group = groupOf(name);
            const double root = tie.multiplier == 0.0 ? 0.0 : (value - tie.offset) / tie.multiplier;
            if (tie.multiplier == 0.0 || (group.held && std::abs(*group.held - root) > kAgree)) {
                refuse("locked " + name, numberText(value),
                       "a value that agrees with joint " + (group.held ? group.heldBy : tie.root) +
                           ", which it follows");
            }
            group.held = root;
            group.heldBy = name;
        }
        for (const auto& [name, tie] : ties_) {
            if (!hasAxis(*model_.getJoint(tie.root))) {
                groups_[tie.root].held = 0.0;
            }
        }
    }

    void checkFinger(const ArmOptions::Finger& wanted) {
        const std::string& name = wanted.joint;
        const auto found = model_.joints_.find(name);
        if (found == model_.joints_.end() || onChain(name)) {
            refuse("finger", "'" + name + "'", "a joint outside the chain from base to tip, listed once");
        }
        const urdf::Joint& joint = *found->second;
        if (!hasAxis(joint) || joint.type == urdf::Joint::CONTINUOUS || !joint.limits) {
            refuse("joint " + name, "no finger", "a revolute or prismatic joint with limits and an axis");
        }
        if (groupOf(name).held || ties_.at(name).multiplier == 0.0) {
            refuse("finger", "'" + name + "', which is locked", "a joint that can move");
        }
        const auto same = [&](const auto& finger) { return finger.joint == name; };
        if (std::count_if(options_.fingers.begin(), options_.fingers.end(), same) > 1) {
            refuse("finger", "named twice", "each finger once");
        }
    }

    void grasp(const ArmOptions::Finger& wanted) {
        checkFinger(wanted);
        const urdf::Joint& joint = *model_.getJoint(wanted.joint);
        const JointTie& tie = ties_.at(wanted.joint);
        Group& group = groupOf(wanted.joint);
        const auto rootAt = [&](double value) { return (value - tie.offset) / tie.multiplier; };
        if (group.finger.empty()) {
            group.finger = wanted.joint;
            const auto [open, closed] = graspEnds(wanted, joint);
            group.open = rootAt(open);
            group.closed = rootAt(closed);
            return;
        }
        for (const auto& [given, root] :
             {std::pair{wanted.open, group.open}, {wanted.closed, group.closed}}) {
            const double follows = tie.offset + tie.multiplier * root;
            if (given && std::abs(*given - follows) > kAgree) {
                refuse("finger " + wanted.joint, numberText(*given),
                       numberText(follows) + ", as it moves with joint " + group.finger);
            }
        }
    }

    // A joint above the base does not move, so neither do the joints of the chain that are tied to it.
    void holdAbove() {
        std::set<std::string> roots; // of the chain
        for (const auto& joint : chain_) {
            if (joint->type != urdf::Joint::FIXED && hasAxis(*joint)) {
                roots.insert(ties_.at(joint->name).root);
            }
        }
        if (chain_.empty()) {
            return;
        }
        auto link = model_.getLink(chain_.front()->parent_link_name);
        for (; link->parent_joint; link = link->getParent()) {
            const std::string& name = link->parent_joint->name;
            above_.insert(name);
            const bool tied = roots.count(ties_.at(name).root) > 0;
            Group& group = groupOf(name);
            if (tied && hasAxis(*link->parent_joint) && !group.held && group.finger.empty()) {
                group.held = restOf(ties_.at(name).root);
                group.heldBy = name;
            }
        }
    }

    // The first joint of each group on the chain leads it, the root before others.
    void leadChain() {
        uint32_t moving = 0;
        for (const auto& joint : chain_) {
            if (joint->type == urdf::Joint::FIXED || !hasAxis(*joint)) {
                continue;
            }
            const JointTie& tie = ties_.at(joint->name);
            Group& group = groupOf(joint->name);
            if (group.held || tie.multiplier == 0.0) {
                continue;
            }
            if (!group.finger.empty()) {
                refuse("finger", "'" + group.finger + "'",
                       "a joint that does not move with joint " + joint->name + " of the chain");
            }
            if (!group.leader || tie.root == joint->name) {
                group.leader = moving;
                group.leaderTie = tie;
                leaders_[tie.root] = joint->name;
            }
            ++moving;
        }
    }

    std::string whyHeld(const urdf::Joint& joint, const JointTie& tie, const Group& group) const {
        if (options_.locked.count(joint.name) > 0) {
            return "locked by the scene";
        }
        if (tie.multiplier == 0.0) {
            return "mimic with multiplier 0";
        }
        if (above_.count(joint.name) > 0) {
            return "above the base";
        }
        if (tie.root == joint.name) {
            return group.heldBy + " follows it, which is " +
                   (above_.count(group.heldBy) > 0 ? "above the base" : "locked by the scene");
        }
        return "follows " + tie.root +
               (model_.getJoint(tie.root)->type == urdf::Joint::FIXED ? ", which is fixed" : "");
    }

    JointDrive driveOf(const urdf::Joint& joint) {
        JointDrive drive;
        const JointTie& tie = ties_.at(joint.name);
        const Group& group = groupOf(joint.name);
        if (!hasAxis(joint)) {
            drive.why = "planar or floating";
            return drive;
        }
        if (group.held || tie.multiplier == 0.0) {
            drive.value = tie.offset + tie.multiplier * group.held.value_or(0.0);
            drive.why = whyHeld(joint, tie, group);
        } else if (group.leader) {
            follow(joint, tie, group, drive);
        } else if (!group.finger.empty()) {
            drive.kind = JointDrive::Kind::Grasps;
            drive.open = tie.offset + tie.multiplier * group.open;
            drive.closed = tie.offset + tie.multiplier * group.closed;
        } else {
            rest(joint, tie, drive);
        }
        return drive;
    }

    void follow(const urdf::Joint& joint, const JointTie& tie, const Group& group, JointDrive& drive) const {
        if (leaders_.at(tie.root) == joint.name) {
            drive.kind = JointDrive::Kind::Free;
            return;
        }
        drive.kind = JointDrive::Kind::Follows;
        const double gain = tie.multiplier / group.leaderTie.multiplier;
        drive.mimic = {*group.leader, gain, tie.offset - gain * group.leaderTie.offset};
    }

    // Of a root that nothing moves: 0, or the nearest limit.
    double restOf(const std::string& name) const {
        const urdf::Joint& root = *model_.getJoint(name);
        const bool limited = root.type != urdf::Joint::CONTINUOUS && root.limits;
        return limited && root.limits->lower <= root.limits->upper
                   ? std::clamp(0.0, root.limits->lower, root.limits->upper)
                   : 0.0;
    }

    // Off the chain and moved by nothing.
    void rest(const urdf::Joint& joint, const JointTie& tie, JointDrive& drive) const {
        drive.value = tie.offset + tie.multiplier * restOf(tie.root);
        drive.why = tie.root == joint.name ? "not between base and tip" : "follows " + tie.root;
    }

    const urdf::ModelInterface& model_;
    const std::filesystem::path& file_;
    const ArmOptions& options_;
    Chain chain_;
    std::map<std::string, JointTie> ties_;
    std::map<std::string, Group> groups_;        // by root
    std::map<std::string, std::string> leaders_; // by root
    std::set<std::string> above_;                // joints above the base
};

} // namespace

bool hasAxis(const urdf::Joint& joint) {
    return joint.type == urdf::Joint::REVOLUTE || joint.type == urdf::Joint::CONTINUOUS ||
           joint.type == urdf::Joint::PRISMATIC;
}

Pose motionOf(const urdf::Joint& joint, double value) {
    const dvec3 axis(joint.axis.x, joint.axis.y, joint.axis.z);
    const dvec3 way = glm::length(axis) > 1e-9 ? value * glm::normalize(axis) : dvec3(0.0);
    return joint.type == urdf::Joint::PRISMATIC ? Pose{way, {1.0, 0.0, 0.0, 0.0}}
                                                : Pose{dvec3(0.0), rotationExp(way)};
}

std::map<std::string, JointDrive> driveJoints(const urdf::ModelInterface& model,
                                              const std::filesystem::path& file, const ArmOptions& options,
                                              std::span<const std::shared_ptr<const urdf::Joint>> chain) {
    return Driver(model, file, options, chain).all();
}

} // namespace fathom
