// SPDX-License-Identifier: Apache-2.0
// URDF to ArmModel.
#include "engine/model/arm_model.h"
#include "engine/model/cover_links.h"
#include "engine/model/urdf_file.h"
#include "engine/types/error.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

namespace fathom {

namespace {

constexpr double kMostSpeed = 100.0; // [rad/s], [m/s] a higher value counts as unlimited

class Loader {
public:
    Loader(const std::filesystem::path& file, const ArmOptions& options)
        : file_(file)
        , options_(options)
        , urdf_(readUrdf(file)) {}

    ArmModel load() {
        const auto base = options_.base.empty() ? urdf_->getRoot() : named(options_.base);
        const auto chain = chainTo(tipOf(base), base);
        Pose before;
        for (const auto& joint : chain) {
            before = before * poseOf(joint->parent_to_joint_origin_transform);
            if (joint->type != urdf::Joint::FIXED) {
                add(*joint, before);
                before = Pose{};
            }
        }
        model_.lastTtip = before;
        addLinks(base, Pose{}, {0, 0});
        if (model_.fingers.size() < options_.fingers.size()) {
            refuseFinger();
        }
        coverShapes();
        if (model_.leaves.empty()) {
            refuse("collision", "no shapes on any link", "links with collision geometry");
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

    LinkPtr named(const std::string& name) const {
        LinkPtr link = urdf_->getLink(name);
        if (!link) {
            std::string names;
            for (const auto& [other, ignored] : urdf_->links_) {
                names += (names.empty() ? "" : ", ") + other;
            }
            refuse("link", "'" + name + "'", names);
        }
        return link;
    }

    // End of the path from `link` with the most moving joints; the first of equals.
    std::pair<LinkPtr, int> deepest(const LinkPtr& link, int moving) const {
        std::pair<LinkPtr, int> best{link, moving};
        for (const auto& joint : link->child_joints) {
            const auto below =
                deepest(urdf_->getLink(joint->child_link_name), moving + (joint->type != urdf::Joint::FIXED));
            best = below.second > best.second ? below : best;
        }
        return best;
    }

    LinkPtr tipOf(const LinkPtr& base) const {
        return options_.tip.empty() ? deepest(base, 0).first : named(options_.tip);
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

    void add(const urdf::Joint& joint, const Pose& before) {
        const std::string field = "joint " + joint.name;
        const bool ticks = joint.type == urdf::Joint::REVOLUTE || joint.type == urdf::Joint::CONTINUOUS;
        if (!ticks && joint.type != urdf::Joint::PRISMATIC) {
            refuse(field, "planar or floating", "revolute, continuous, prismatic or fixed");
        }
        if (model_.joints.size() == kMostJoints) {
            refuse(field, "one more moving joint", std::to_string(kMostJoints) + " at most from base to tip");
        }
        const dvec3 axis(joint.axis.x, joint.axis.y, joint.axis.z);
        ArmJoint out{joint.name,
                     !ticks,
                     before,
                     axis,
                     -std::numeric_limits<double>::infinity(),
                     std::numeric_limits<double>::infinity(),
                     kMostSpeed};
        if (joint.limits) {
            out.speed =
                joint.limits->velocity > 0.0 ? std::min(joint.limits->velocity, kMostSpeed) : kMostSpeed;
        }
        if (joint.type != urdf::Joint::CONTINUOUS) {
            if (!joint.limits || !(joint.limits->lower <= joint.limits->upper)) {
                refuse(field, "limits missing or crossed", "lower <= upper");
            }
            out.lower = joint.limits->lower;
            out.upper = joint.limits->upper;
        }
        if (!(glm::length(axis) > 1e-9)) {
            refuse(field, "axis of no length", "a direction");
        }
        out.axis = glm::normalize(axis);
        model_.joints.push_back(out);
        moving_.push_back(joint.name);
    }

    struct Carrier {     // of a link
        uint32_t joint;  // number of chain joints
        uint32_t finger; // 0 = none, else one more than its index
    };

    // Shapes of `link` and of its descendants, in the frame of the chain joint that carries them.
    void addLinks(const LinkPtr& link, const Pose& frameTlink, const Carrier& carrier) {
        const auto index = static_cast<uint32_t>(model_.links.size());
        for (const auto& collision : link->collision_array) {
            shapes_.push_back({link, collision, frameTlink * poseOf(collision->origin), carrier, index});
        }
        if (!link->collision_array.empty()) {
            model_.links.push_back(link->name);
        } else if (!link->visual_array.empty() || link->inertial) { // else it is only a frame
            model_.notes.push_back("link " + link->name + " has no collision shape and can enter regions");
        }
        for (const auto& below : link->child_joints) {
            const LinkPtr child = urdf_->getLink(below->child_link_name);
            const auto chained = std::find(moving_.begin(), moving_.end(), below->name);
            const Pose place = frameTlink * poseOf(below->parent_to_joint_origin_transform);
            if (chained != moving_.end()) {
                addLinks(child, Pose{}, {static_cast<uint32_t>(chained - moving_.begin()) + 1, 0});
            } else if (carrier.finger == 0 && addFinger(*below, place, carrier.joint)) {
                addLinks(child, Pose{}, {carrier.joint, static_cast<uint32_t>(model_.fingers.size())});
            } else {
                addLinks(child, place, carrier);
            }
        }
    }

    // Returns false when the options name no such finger.
    bool addFinger(const urdf::Joint& joint, const Pose& before, uint32_t carriedBy) {
        const auto wanted = std::find_if(options_.fingers.begin(), options_.fingers.end(),
                                         [&](const auto& finger) { return finger.joint == joint.name; });
        if (wanted == options_.fingers.end()) {
            return false;
        }
        const bool slides = joint.type == urdf::Joint::PRISMATIC;
        const dvec3 axis(joint.axis.x, joint.axis.y, joint.axis.z);
        if ((!slides && joint.type != urdf::Joint::REVOLUTE) || !joint.limits ||
            !(glm::length(axis) > 1e-9)) {
            refuse("joint " + joint.name, "no finger",
                   "a revolute or prismatic joint with limits and an axis");
        }
        if (model_.fingers.size() == kMostFingers) {
            refuse("joint " + joint.name, "one more finger", std::to_string(kMostFingers) + " at most");
        }
        model_.fingers.push_back({joint.name, carriedBy, slides, before, glm::normalize(axis),
                                  wanted->open.value_or(joint.limits->lower),
                                  wanted->closed.value_or(joint.limits->upper), joint.limits->lower,
                                  joint.limits->upper});
        return true;
    }

    [[noreturn]] void refuseFinger() const {
        for (const auto& wanted : options_.fingers) {
            const auto same = [&](const ArmFinger& finger) { return finger.name == wanted.joint; };
            if (std::none_of(model_.fingers.begin(), model_.fingers.end(), same)) {
                refuse(
                    "finger", "'" + wanted.joint + "'",
                    "a joint outside the chain from base to tip, not carried by another finger, listed once");
            }
        }
        refuse("finger", "named twice", "each finger once");
    }

    struct Shape {
        LinkPtr link;
        std::shared_ptr<const urdf::Collision> collision;
        Pose frameTshape;
        Carrier carrier;
        uint32_t index; // of the link among those with shapes
    };

    void coverShapes() {
        std::vector<LinkGeometry> all;
        for (const Shape& shape : shapes_) {
            all.push_back({shape.link->name, shape.collision->geometry});
        }
        const auto made = spheresOf(all, {file_, options_.meshes}, options_.leavesPerShape);
        for (size_t i = 0; i < shapes_.size(); ++i) {
            addSpheres(shapes_[i], made[i]);
        }
        if (!outside_.empty()) {
            model_.notes.push_back("meshes outside their search folder: " + std::to_string(outside_.size()) +
                                   ", the first " + *outside_.begin());
        }
    }

    void addSpheres(const Shape& shape, const ShapeSpheres& made) {
        for (const std::string& note : made.notes) {
            model_.notes.push_back("link " + shape.link->name + ": " + note);
        }
        if (!made.outside.empty()) {
            outside_.insert(made.outside.lexically_normal().string());
        }
        for (const Sphere& s : made.spheres) {
            model_.leaves.push_back({{shape.frameTshape.apply(s.centre), s.radius},
                                     shape.carrier.joint,
                                     shape.index,
                                     shape.carrier.finger});
        }
    }

    std::filesystem::path file_;
    ArmOptions options_;
    std::shared_ptr<const urdf::ModelInterface> urdf_;
    ArmModel model_;
    std::vector<std::string> moving_;
    std::vector<Shape> shapes_;
    std::set<std::string> outside_; // files
};

} // namespace

ArmModel loadArm(const std::filesystem::path& urdf, const ArmOptions& options) {
    return Loader(urdf, options).load();
}

} // namespace fathom
