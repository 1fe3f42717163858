// SPDX-License-Identifier: Apache-2.0
// Bodies of an MJCF file as links and joints of a URDF.
#pragma once

#include "engine/reader/mjcf_geom.h"
#include "engine/reader/mjcf_pose.h"

#include <map>
#include <set>
#include <string>
#include <vector>

namespace fathom {

class MjcfBodies {
public:
    // file: for messages. All <include> are expanded.
    MjcfBodies(const std::string& file, const tinyxml2::XMLElement& root);

    std::string urdf(); // throws BadInput
    // On what is not read, or read otherwise; complete after urdf().
    const std::vector<std::string>& notes() const { return notes_; }

private:
    // An element below a body, possibly inside of <frame>, which gives it a pose and a class.
    struct Part {
        const tinyxml2::XMLElement* element;
        std::string childClass;
        Pose at; // of the frame in the body
    };
    struct Contents {
        std::vector<Part> joints, geoms, bodies, sites;
    };

    void readEqualities();
    void readNames(const tinyxml2::XMLElement& element);
    void collect(const tinyxml2::XMLElement& element, const std::string& childClass, const Pose& at,
                 Contents& out) const;
    // still: the parent does not move relative to the world.
    void addBody(const Part& body, const std::string& parent, bool still);
    void dropWorldGeoms(std::vector<Part>& geoms);
    // Adds a joint from `parent` to `child`; before: pose of the joint's body in the parent. Returns the
    // pose of that body in the child: the anchor's offset.
    Pose addJoint(const Part& joint, const std::string& name, const std::string& parent,
                  const std::string& child, const Pose& before);
    Pose anchorOf(const Part& joint) const;
    std::string limitsOf(const Part& joint, const std::string& name, bool slides, bool& continuous) const;
    void addLink(const std::string& name, const std::vector<Part>& geoms);
    void addFixed(const std::string& name, const std::string& parent, const std::string& child,
                  const Pose& parentTchild);
    void addSite(const Part& site, const std::string& body);
    std::string nameOf(const tinyxml2::XMLElement& element, const char* otherwise);
    std::string unusedName(const std::string& stem, const std::string& ending);

    const tinyxml2::XMLElement& root_;
    MjcfClasses classes_;
    MjcfAngles angles_;
    MjcfGeoms geoms_;
    bool autoLimits_ = true;
    struct Equality {
        std::string other; // empty = the joint is held
        double offset, multiplier;
    };
    std::map<std::string, Equality> equalities_;
    std::string out_;
    std::vector<std::string> notes_;
    std::set<std::string> bodyNames_; // stated ones, and "world"
    std::set<std::string> names_;     // of all bodies, sites and joints, stated or made here
    int unnamed_ = 0, dropped_ = 0;
    std::string firstDropped_;
};

} // namespace fathom
