// SPDX-License-Identifier: Apache-2.0
// Forward kinematics of a dozen robots against Orocos KDL. Mimic joints and joints off the chain get their
// values here, independently of the engine.
#include "engine/model/urdf_file.h"
#include "tests/model/urdf_text.h"

#include <doctest/doctest.h>
#include <kdl/tree.hpp>
#include <kdl/treefksolverpos_recursive.hpp>
#include <map>
#include <random>
#include <urdf_model/model.h>

using namespace fathom;
using namespace fathom::testing;

namespace {

constexpr double kAgree = 1e-9; // [m]

KDL::Frame frameOf(const urdf::Pose& pose) {
    const auto& r = pose.rotation;
    return {KDL::Rotation::Quaternion(r.x, r.y, r.z, r.w),
            KDL::Vector(pose.position.x, pose.position.y, pose.position.z)};
}

KDL::Joint jointOf(const urdf::Joint& joint) {
    const KDL::Frame frame = frameOf(joint.parent_to_joint_origin_transform);
    const KDL::Vector axis = frame.M * KDL::Vector(joint.axis.x, joint.axis.y, joint.axis.z);
    switch (joint.type) {
    case urdf::Joint::REVOLUTE:
    case urdf::Joint::CONTINUOUS:
        return {joint.name, frame.p, axis, KDL::Joint::RotAxis};
    case urdf::Joint::PRISMATIC:
        return {joint.name, frame.p, axis, KDL::Joint::TransAxis};
    default:
        return KDL::Joint(joint.name, KDL::Joint::None);
    }
}

void grow(KDL::Tree& tree, const urdf::Link& link) {
    for (const auto& joint : link.child_joints) {
        const KDL::Segment segment(joint->child_link_name, jointOf(*joint),
                                   frameOf(joint->parent_to_joint_origin_transform));
        REQUIRE(tree.addSegment(segment, link.name));
        for (const auto& child : link.child_links) {
            if (child->name == joint->child_link_name) {
                grow(tree, *child);
            }
        }
    }
}

struct Robot {
    std::string name, inside; // of <robot>
    ArmOptions options;
};

class Compared {
public:
    explicit Compared(const Robot& robot)
        : arm_(loadUrdf(robot.inside, robot.options))
        , options_(robot.options) {
        urdf_ = readUrdf(urdfFile(robot.inside).path());
        tree_ = KDL::Tree(urdf_->getRoot()->name);
        grow(tree_, *urdf_->getRoot());
    }

    // Largest distance between the two places of any leaf, seen from the base.
    double worst(std::mt19937_64& random) {
        JointVector q{};
        std::uniform_real_distribution<double> share(0.0, 1.0);
        for (size_t k = 0; k < arm_.count(); ++k) {
            const ArmJoint& joint = arm_.joints[k];
            const double low = std::max(joint.lower, -3.0), high = std::min(joint.upper, 3.0);
            q[k] = joint.mimic ? 0.0 : low + share(random) * (high - low);
        }
        const double grasp = share(random);
        arm_.follow(q);
        ArmFrames frames;
        arm_.place(q, Pose{}, frames, grasp);
        setMasters(q, grasp);
        const KDL::Frame base = placeOf(arm_.baseText.substr(0, arm_.baseText.find(' ')));
        double worst = 0.0;
        for (size_t i = 0; i < arm_.leaves.size(); ++i) {
            const KDL::Frame link = base.Inverse() * placeOf(arm_.links[arm_.leaves[i].link]);
            const dvec3 ours = arm_.centre(frames, i);
            worst = std::max(worst, glm::distance(ours, dvec3(link.p.x(), link.p.y(), link.p.z())));
        }
        const KDL::Frame tip = base.Inverse() * placeOf(arm_.tipText.substr(0, arm_.tipText.find(' ')));
        double x = 0, y = 0, z = 0, w = 0;
        tip.M.GetQuaternion(x, y, z, w);
        const Pose ours = arm_.tip(frames);
        const double turn = 1.0 - std::abs(glm::dot(ours.rotation, dquat(w, x, y, z)));
        return std::max({worst, glm::distance(ours.position, dvec3(tip.p.x(), tip.p.y(), tip.p.z())), turn});
    }

private:
    void setMasters(const JointVector& q, double grasp) {
        values_.clear();
        for (size_t k = 0; k < arm_.count(); ++k) {
            if (!arm_.joints[k].mimic) {
                values_[arm_.joints[k].name] = q[k];
            }
        }
        for (const auto& finger : options_.fingers) {
            const auto& limits = *urdf_->getJoint(finger.joint)->limits;
            const double open = finger.open.value_or(limits.lower),
                         closed = finger.closed.value_or(limits.upper);
            values_[finger.joint] = open + grasp * (closed - open);
        }
        for (const auto& [name, value] : options_.locked) {
            values_[name] = value;
        }
    }

    double valueOf(const urdf::Joint& joint) const {
        if (const auto known = values_.find(joint.name); known != values_.end()) {
            return known->second;
        }
        if (joint.mimic) {
            return joint.mimic->offset +
                   joint.mimic->multiplier * valueOf(*urdf_->getJoint(joint.mimic->joint_name));
        }
        const bool limited = joint.limits && joint.type != urdf::Joint::CONTINUOUS;
        return limited ? std::clamp(0.0, joint.limits->lower, joint.limits->upper) : 0.0;
    }

    KDL::Frame placeOf(const std::string& link) const {
        KDL::JntArray q(tree_.getNrOfJoints());
        for (const auto& [name, element] : tree_.getSegments()) {
            const KDL::Joint& joint = element.segment.getJoint();
            if (joint.getType() != KDL::Joint::None) {
                q(element.q_nr) = valueOf(*urdf_->getJoint(joint.getName()));
            }
        }
        KDL::TreeFkSolverPos_recursive solver(tree_);
        KDL::Frame frame;
        REQUIRE(solver.JntToCart(q, frame, link) == 0);
        return frame;
    }

    ArmModel arm_;
    ArmOptions options_;
    std::shared_ptr<const urdf::ModelInterface> urdf_;
    KDL::Tree tree_;
    std::map<std::string, double> values_;
};

const std::string kTurn = "<limit lower='-2' upper='2.5' velocity='1' effort='1'/>";
const std::string kSlide = "<limit lower='0.02' upper='0.3' velocity='0.2' effort='1'/>";

// A joint with a slanted origin and axis; the k-th of a robot.
std::string slanted(size_t k, const std::string& type, const std::string& parent, const std::string& child,
                    const std::string& more) {
    const std::string n = std::to_string(k % 7 + 1);
    return "<joint name='j" + std::to_string(k) + "' type='" + type + "'><parent link='" + parent +
           "'/><child link='" + child + "'/><origin xyz='0." + n + " -0.0" + n + " 0.2' rpy='0." + n + " 1." +
           n + " -2." + n + "'/><axis xyz='" +
           (k % 3 == 0   ? "0 0 1"
            : k % 3 == 1 ? "1 -2 0.5"
                         : "0 -1 0") +
           "'/>" + more + "</joint>";
}

// A chain of links l0, l1, ... with these joint types.
std::string chainOf(const std::vector<std::string>& types) {
    std::string inside = ballLink("l0");
    for (size_t k = 0; k < types.size(); ++k) {
        const std::string child = "l" + std::to_string(k + 1);
        inside += ballLink(child);
        inside += slanted(k, types[k], "l" + std::to_string(k), child,
                          types[k] == "prismatic"  ? kSlide
                          : types[k] == "revolute" ? kTurn
                                                   : "");
    }
    return inside;
}

std::string branch(const std::string& name, const std::string& parent, const std::string& type,
                   const std::string& more) {
    return ballLink(name) + jointText("b_" + name, type, parent, name, "0.1 0.2 0.3", "1 2 -1", more);
}

std::vector<Robot> robots() {
    const std::string r = "revolute", p = "prismatic", c = "continuous", f = "fixed";
    const std::string four = chainOf({r, r, r, r});
    ArmOptions hand, inner, locked, grip, robotiq;
    hand.tip = "l2";
    inner.base = "l2";
    locked.locked = {{"j1", 0.7}, {"j3", -0.4}};
    grip.tip = "l4";
    grip.fingers = {{"b_left", 0.25, 0.03}};
    robotiq.tip = "l4";
    robotiq.fingers = {{"b_knuckle", {}, {}}};
    const std::string mimic = mimicText("j0", "multiplier='-0.5' offset='0.3'");
    std::string coupled = chainOf({r, r, r});
    coupled.insert(coupled.find("</joint>", coupled.find("name='j1'")), mimic);
    std::string twice = coupled;
    twice.insert(twice.find("</joint>", twice.find("name='j2'")),
                 mimicText("j1", "multiplier='-1' offset='0.1'"));
    return {
        {"revolute", four, {}},
        {"prismatic", chainOf({p, r, p, r}), {}},
        {"continuous and fixed", chainOf({c, f, c, f, r, f}), {}},
        {"seven", chainOf({r, r, r, r, r, r, r}), {}},
        {"eight with a rail", chainOf({p, r, r, r, r, r, r, r}), {}},
        {"to a link in the middle", four, hand},
        {"from a link in the middle", four + branch("mast", "l1", "fixed", ""), inner},
        {"locked", four, locked},
        {"mimic in the chain", coupled, {}},
        {"mimic of a mimic", twice, {}},
        {"parallel jaws",
         four + branch("left", "l4", p, kSlide) + branch("right", "l4", p, kSlide + mimicText("b_left")),
         grip},
        {"fingers on fingers",
         four + branch("knuckle", "l4", r, kTurn) +
             branch("inner", "knuckle", r, kTurn + mimicText("b_knuckle", "multiplier='-1' offset='0.2'")) +
             branch("pad", "inner", r, kTurn + mimicText("b_inner", "multiplier='0.5'")),
         robotiq},
        {"a crank off the chain",
         four + branch("crank", "l0", r, kTurn + mimicText("j2", "multiplier='2'")),
         {}},
        {"a wheel and a head", four + branch("wheel", "l0", c, "") + branch("head", "l1", p, kSlide), {}}};
}

} // namespace

TEST_CASE("Every link of a dozen robots is where Orocos KDL puts it, at random joint values") {
    std::mt19937_64 random(5);
    for (const Robot& robot : robots()) {
        CAPTURE(robot.name);
        Compared compared(robot);
        for (int i = 0; i < 50; ++i) {
            CHECK(compared.worst(random) < kAgree);
        }
    }
}
