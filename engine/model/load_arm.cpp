// SPDX-License-Identifier: Apache-2.0
// URDF to ArmModel.
#include "engine/model/arm_model.h"
#include "engine/model/mesh_file.h"
#include "engine/model/sphere_cover.h"
#include "engine/model/urdf_file.h"
#include "engine/types/error.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fathom {

namespace {

constexpr double kMostSpeed = 100.0; // [rad/s], [m/s] anything above is no limit

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

    // End of the way from `link` with most moving joints; the first of equals.
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
        const bool turns = joint.type == urdf::Joint::REVOLUTE || joint.type == urdf::Joint::CONTINUOUS;
        if (!turns && joint.type != urdf::Joint::PRISMATIC) {
            refuse(field, "planar or floating", "revolute, continuous, prismatic or fixed");
        }
        if (model_.joints.size() == kMostJoints) {
            refuse(field, "one more moving joint", std::to_string(kMostJoints) + " at most from base to tip");
        }
        const dvec3 axis(joint.axis.x, joint.axis.y, joint.axis.z);
        ArmJoint out{joint.name,
                     !turns,
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
        uint32_t joint;  // how many joints of the chain
        uint32_t finger; // 0 = none, else one more than its index
    };

    // Spheres of `link` and of all that it carries, in its carrier's frame.
    void addLinks(const LinkPtr& link, const Pose& frameTlink, const Carrier& carrier) {
        const size_t before = model_.leaves.size();
        for (const auto& collision : link->collision_array) {
            addShape(*link, *collision, frameTlink * poseOf(collision->origin), carrier);
        }
        if (model_.leaves.size() > before) {
            model_.links.push_back(link->name);
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

    // False: the options name no such finger.
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
                                  wanted->closed.value_or(joint.limits->upper)});
        return true;
    }

    [[noreturn]] void refuseFinger() const {
        for (const auto& wanted : options_.fingers) {
            const auto same = [&](const ArmFinger& finger) { return finger.name == wanted.joint; };
            if (std::none_of(model_.fingers.begin(), model_.fingers.end(), same)) {
                refuse("finger", "'" + wanted.joint + "'",
                       "a joint beside the chain from base to tip that no other finger carries, named once");
            }
        }
        refuse("finger", "named twice", "each finger once");
    }

    void addShape(const urdf::Link& link, const urdf::Collision& collision, const Pose& place,
                  const Carrier& carrier) {
        const auto keep = [&](const Sphere& s) {
            if (!isFinite(s.centre) || !(s.radius > 0.0)) {
                refuse("link " + link.name, "a sphere without radius", "radii above 0");
            }
            model_.leaves.push_back({{place.apply(s.centre), s.radius},
                                     carrier.joint,
                                     static_cast<uint32_t>(model_.links.size()),
                                     carrier.finger});
        };
        if (const auto* ball = dynamic_cast<const urdf::Sphere*>(collision.geometry.get())) {
            keep({dvec3(0.0), ball->radius});
            return;
        }
        LoadedMesh loaded = meshOf(link, *collision.geometry);
        const MeshDistance distance(loaded.mesh, loaded.facts.closed());
        CoverOptions cover;
        cover.leaves = options_.leavesPerShape;
        cover.effort = 0;
        for (const Sphere& s : coverMesh(loaded.mesh, distance, cover).spheres) {
            keep(s);
        }
    }

    LoadedMesh meshOf(const urdf::Link& link, const urdf::Geometry& shape) const {
        LoadedMesh loaded;
        if (const auto* box = dynamic_cast<const urdf::Box*>(&shape)) {
            loaded.mesh = prism(4, {0.5 * box->dim.x, 0.5 * box->dim.y}, box->dim.z);
        } else if (const auto* tube = dynamic_cast<const urdf::Cylinder*>(&shape)) {
            // Twenty-four sides about the circle: the flats lie outside it.
            const double radius = tube->radius / std::cos(3.14159265358979323846 / 24.0);
            loaded.mesh = prism(24, {radius, radius}, tube->length);
        } else if (const auto* mesh = dynamic_cast<const urdf::Mesh*>(&shape)) {
            MeshOptions options;
            options.scale = mesh->scale.x;
            options.dropStray = true; // an arm's parts are near each other whatever the file holds besides
            return loadMesh(pathOf(mesh->filename), options);
        }
        loaded.facts = tidy(loaded.mesh, 0.0);
        if (loaded.mesh.triangles.empty()) {
            refuse("link " + link.name, "a shape without size", "positive sizes");
        }
        return loaded;
    }

    // Upright about z; a rectangle for four corners.
    static TriangleMesh prism(uint32_t sides, const std::array<double, 2>& half, double length) {
        TriangleMesh mesh;
        for (uint32_t i = 0; i < sides; ++i) {
            const double turn = 6.283185307179586 * (i + 0.5) / sides,
                         wide = sides == 4 ? std::sqrt(2.0) : 1.0;
            for (double z : {-0.5 * length, 0.5 * length}) {
                mesh.points.emplace_back(half[0] * wide * std::cos(turn), half[1] * wide * std::sin(turn), z);
            }
            const uint32_t a = 2 * i, b = 2 * ((i + 1) % sides);
            mesh.triangles.insert(mesh.triangles.end(), {{a, b, b + 1}, {a, b + 1, a + 1}});
            if (i > 0 && i + 1 < sides) {
                mesh.triangles.insert(mesh.triangles.end(), {{0, b, a}, {1, a + 1, b + 1}});
            }
        }
        return mesh;
    }

    std::filesystem::path pathOf(std::string name) const {
        for (const std::string scheme : {"package://", "file://"}) {
            name = name.rfind(scheme, 0) == 0 ? name.substr(scheme.size()) : name;
        }
        if (!options_.meshes.empty()) {
            return options_.meshes / name;
        }
        std::filesystem::path folder = file_.parent_path();
        for (int up = 0; up < 3 && !std::filesystem::exists(folder / name); ++up) {
            folder /= "..";
        }
        return folder / name;
    }

    std::filesystem::path file_;
    ArmOptions options_;
    std::shared_ptr<const urdf::ModelInterface> urdf_;
    ArmModel model_;
    std::vector<std::string> moving_;
};

} // namespace

ArmModel loadArm(const std::filesystem::path& urdf, const ArmOptions& options) {
    return Loader(urdf, options).load();
}

} // namespace fathom
