// SPDX-License-Identifier: Apache-2.0
#include "engine/reader/mjcf_body.h"

#include "engine/model/link_names.h"
#include "engine/model/xml_text.h"
#include "engine/types/printable.h"

#include <set>

namespace fathom {

namespace {

std::string stated(const tinyxml2::XMLElement& element, const char* name, const char* otherwise = "") {
    const char* const text = element.Attribute(name);
    return text != nullptr ? text : otherwise;
}

constexpr double kEndless = 1e4; // [m] limit of slides without limits

// Elements that make bodies, joints or geoms in a way that this does not follow.
const std::set<std::string>& unread() {
    static const std::set<std::string> kAll{"replicate", "composite", "flexcomp", "attach", "skin"};
    return kAll;
}

} // namespace

MjcfBodies::MjcfBodies(const std::string& file, const tinyxml2::XMLElement& root)
    : root_(root)
    , classes_(file, root)
    , angles_(mjcfAngles(classes_, root))
    , geoms_(classes_, angles_, root) {
    for (auto* compiler = root.FirstChildElement("compiler"); compiler != nullptr;
         compiler = compiler->NextSiblingElement("compiler")) {
        autoLimits_ = stated(*compiler, "autolimits", autoLimits_ ? "true" : "false") != "false";
    }
    readEqualities();
    bodyNames_.insert("world");
    names_.insert("world");
    readNames(root);
}

void MjcfBodies::readNames(const tinyxml2::XMLElement& element) {
    for (auto* child = element.FirstChildElement(); child != nullptr; child = child->NextSiblingElement()) {
        const std::string kind = child->Name(), name = stated(*child, "name");
        if (kind == "body") {
            bodyNames_.insert(name);
        }
        if (kind == "body" || kind == "site" || kind == "joint" || kind == "freejoint") {
            names_.insert(name);
        }
        readNames(*child);
    }
}

// joint1 = c0 + c1 joint2, each measured from its `ref`; higher powers are no mimic joint.
void MjcfBodies::readEqualities() {
    std::vector<const tinyxml2::XMLElement*> others;
    for (auto* all = root_.FirstChildElement("equality"); all != nullptr;
         all = all->NextSiblingElement("equality")) {
        for (auto* joint = all->FirstChildElement(); joint != nullptr; joint = joint->NextSiblingElement()) {
            const char* const active = classes_.find(*joint, "", "active");
            if (active != nullptr && std::string(active) == "false") {
                continue;
            }
            if (std::string(joint->Name()) != "joint") {
                others.push_back(joint);
                continue;
            }
            auto c = classes_.numbers(*joint, "", "polycoef", {0.0, 1.0}, 1, 5);
            if (c.size() == 1) {
                c.push_back(1.0); // MuJoCo keeps its default where none is given
            }
            c.resize(5, 0.0);
            if (c[2] != 0.0 || c[3] != 0.0 || c[4] != 0.0) {
                classes_.refuse(*joint, "polycoef with powers above 1", "c0 c1 0 0 0");
            }
            equalities_[stated(*joint, "joint1")] = {stated(*joint, "joint2"), c[0], c[1]};
        }
    }
    if (!others.empty()) {
        notes_.push_back(std::to_string(others.size()) + " equalities that are no <joint>, the first <" +
                         printable(others[0]->Name()) + "> in " + mjcfPlace(*others[0], "").line +
                         ", are not read: loops stay open");
    }
}

std::string MjcfBodies::urdf() {
    out_ = "<robot name='" + xmlEscaped(stated(root_, "model", "mjcf")) + "'><link name='world'/>";
    for (auto* world = root_.FirstChildElement("worldbody"); world != nullptr;
         world = world->NextSiblingElement("worldbody")) {
        Contents contents;
        collect(*world, "", Pose{}, contents);
        for (const Part& body : contents.bodies) {
            addBody(body, "world", true);
        }
    }
    if (dropped_ > 0) {
        notes_.push_back(std::to_string(dropped_) +
                         " planes or height fields of bodies that do not move, the first in " +
                         firstDropped_ + ", are not read");
    }
    if (geoms_.fitted() > 0) {
        notes_.push_back(std::to_string(geoms_.fitted()) +
                         " primitives are fitted to meshes: the meshes are covered instead");
    }
    return out_ + "</robot>";
}

void MjcfBodies::collect(const tinyxml2::XMLElement& element, const std::string& childClass, const Pose& at,
                         Contents& out) const {
    for (auto* child = element.FirstChildElement(); child != nullptr; child = child->NextSiblingElement()) {
        const std::string kind = child->Name();
        const std::string inner = stated(*child, "childclass", childClass.c_str());
        if (kind == "joint" || kind == "freejoint") {
            out.joints.push_back({child, childClass, at});
        } else if (kind == "geom") {
            out.geoms.push_back({child, childClass, at});
        } else if (kind == "body") {
            out.bodies.push_back({child, inner, at});
        } else if (kind == "site") {
            out.sites.push_back({child, childClass, at});
        } else if (kind == "frame") {
            collect(*child, inner, at * mjcfPose(classes_, angles_, *child, ""), out);
        } else if (unread().count(kind) != 0) {
            classes_.refuse(*child, "not read",
                            "bodies, frames, joints and geoms; MuJoCo can save an expanded file");
        }
    }
}

std::string MjcfBodies::nameOf(const tinyxml2::XMLElement& element, const char* otherwise) {
    std::string name = stated(element, "name");
    if (name.empty()) {
        do {
            name = otherwise + std::to_string(++unnamed_);
        } while (!names_.insert(name).second);
    }
    return name;
}

// stem + ending, with a number between them if an element has that name.
std::string MjcfBodies::unusedName(const std::string& stem, const std::string& ending) {
    std::string name = stem + ending;
    for (int k = 2; !names_.insert(name).second; ++k) {
        name = stem + "__" + std::to_string(k) + ending;
    }
    return name;
}

void MjcfBodies::addBody(const Part& body, const std::string& parent, bool still) {
    Contents contents;
    collect(*body.element, body.childClass, Pose{}, contents);
    const std::string name = nameOf(*body.element, "body_");
    std::string link = parent;
    Pose before = body.at * mjcfPose(classes_, angles_, *body.element, "");
    for (size_t i = 0; i < contents.joints.size(); ++i) {
        const Part& joint = contents.joints[i];
        const bool last = i + 1 == contents.joints.size();
        const bool moved = glm::length(anchorOf(joint).position) > 0.0;
        const std::string child = last && !moved ? name : unusedName(name, "__" + std::to_string(i + 1));
        if (child != name) {
            out_ += "<link name='" + xmlEscaped(child) + "'/>";
        }
        before = addJoint(joint, nameOf(*joint.element, "joint_"), link, child, before);
        link = child;
    }
    if (link != name) {
        addFixed(unusedName(name, "__fixed"), link, name, before);
    }
    still = still && contents.joints.empty();
    if (still) {
        dropWorldGeoms(contents.geoms);
    }
    addLink(name, contents.geoms);
    for (const Part& site : contents.sites) {
        addSite(site, name);
    }
    for (const Part& inner : contents.bodies) {
        addBody(inner, name, still);
    }
}

// Planes and height fields, which MuJoCo allows where nothing moves, as in the world itself.
void MjcfBodies::dropWorldGeoms(std::vector<Part>& geoms) {
    std::erase_if(geoms, [&](const Part& geom) {
        const char* const type = classes_.find(*geom.element, geom.childClass, "type");
        const bool drops = type != nullptr && (std::string(type) == "plane" || std::string(type) == "hfield");
        if (drops && ++dropped_ == 1) {
            firstDropped_ = mjcfPlace(*geom.element, "").line;
        }
        return drops;
    });
}

// The joint's anchor in its body, with the turn of the frame that the joint is in.
Pose MjcfBodies::anchorOf(const Part& joint) const {
    const auto p = classes_.numbers(*joint.element, joint.childClass, "pos", {0.0, 0.0, 0.0}, 3, 3);
    return {joint.at.apply({p[0], p[1], p[2]}), joint.at.rotation};
}

Pose MjcfBodies::addJoint(const Part& joint, const std::string& name, const std::string& parent,
                          const std::string& child, const Pose& before) {
    const char* const found = classes_.find(*joint.element, joint.childClass, "type");
    const std::string type = std::string(joint.element->Name()) == "freejoint" ? "free"
                             : found != nullptr                                ? found
                                                                               : "hinge";
    if (type != "hinge" && type != "slide" && type != "ball" && type != "free") {
        classes_.refuse(*joint.element, "type=\"" + type + "\"", "hinge, slide, ball or free");
    }
    const Pose anchor = anchorOf(joint);
    const auto a = classes_.numbers(*joint.element, joint.childClass, "axis", {0.0, 0.0, 1.0}, 3, 3);
    const dvec3 axis = anchor.rotation * dvec3(a[0], a[1], a[2]);
    const bool turns = type == "hinge" || type == "slide";
    bool continuous = false;
    const std::string limits = turns ? limitsOf(joint, name, type == "slide", continuous) : "";
    out_ += "<joint name='" + xmlEscaped(name) + "' type='" +
            (!turns            ? "floating"
             : type == "slide" ? "prismatic"
             : continuous      ? "continuous"
                               : "revolute") +
            "'>" + "<parent link='" + xmlEscaped(parent) + "'/><child link='" + xmlEscaped(child) + "'/>" +
            urdfOrigin(before * Pose{anchor.position, {1.0, 0.0, 0.0, 0.0}});
    if (turns) {
        out_ +=
            "<axis xyz='" + urdfNumber(axis.x) + " " + urdfNumber(axis.y) + " " + urdfNumber(axis.z) + "'/>";
    }
    out_ += limits + "</joint>";
    return {-anchor.position, {1.0, 0.0, 0.0, 0.0}};
}

// <limit> and <mimic>; no speeds, because MJCF states none.
std::string MjcfBodies::limitsOf(const Part& joint, const std::string& name, bool slides,
                                 bool& continuous) const {
    const double unit = slides ? 1.0 : angles_.perUnit;
    const auto range = classes_.numbers(*joint.element, joint.childClass, "range", {}, 2, 2);
    const double ref = classes_.numbers(*joint.element, joint.childClass, "ref", {0.0}, 1, 1)[0];
    const char* const limited = classes_.find(*joint.element, joint.childClass, "limited");
    const std::string says = limited != nullptr ? limited : "auto";
    // Where nothing says that the joint is limited, a range that does not rise takes back an inherited one.
    const bool bounded =
        !range.empty() && (says == "true" || (says == "auto" && autoLimits_ && range[0] < range[1]));
    const auto equality = equalities_.find(name);
    const bool held = equality != equalities_.end() && equality->second.other.empty();
    continuous = !bounded && !held && !slides;
    std::string text;
    if (held || bounded || slides) { // a URDF has no slides without limits
        const double lower = held ? equality->second.offset : bounded ? (range[0] - ref) * unit : -kEndless;
        const double upper = held ? equality->second.offset : bounded ? (range[1] - ref) * unit : kEndless;
        text = "<limit lower='" + urdfNumber(lower) + "' upper='" + urdfNumber(upper) +
               "' velocity='0' effort='0'/>";
    }
    if (equality != equalities_.end() && !held) {
        text += "<mimic joint='" + xmlEscaped(equality->second.other) + "' multiplier='" +
                urdfNumber(equality->second.multiplier) + "' offset='" + urdfNumber(equality->second.offset) +
                "'/>";
    }
    return text;
}

void MjcfBodies::addLink(const std::string& name, const std::vector<Part>& geoms) {
    out_ += "<link name='" + xmlEscaped(name) + "'>";
    for (const Part& geom : geoms) {
        out_ += geoms_.shape(*geom.element, geom.childClass, geom.at);
    }
    out_ += "</link>";
}

void MjcfBodies::addFixed(const std::string& name, const std::string& parent, const std::string& child,
                          const Pose& parentTchild) {
    out_ += "<joint name='" + xmlEscaped(name) + "' type='fixed'><parent link='" + xmlEscaped(parent) +
            "'/><child link='" + xmlEscaped(child) + "'/>" + urdfOrigin(parentTchild) + "</joint>";
}

// A link without shapes, which may be the tip. Sites and bodies have names of their own in MuJoCo.
void MjcfBodies::addSite(const Part& site, const std::string& body) {
    const std::string name = stated(*site.element, "name");
    if (name.empty()) {
        return;
    }
    const std::string link = bodyNames_.count(name) != 0 ? unusedName(name, kSiteEnding) : name;
    addLink(link, {});
    addFixed(unusedName(name, kSiteEnding), body, link,
             site.at * mjcfShapePose(classes_, angles_, *site.element, site.childClass).pose);
}

} // namespace fathom
