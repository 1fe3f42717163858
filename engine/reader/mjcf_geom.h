// SPDX-License-Identifier: Apache-2.0
// Geoms of an MJCF file as shapes of a URDF.
#pragma once

#include "engine/reader/mjcf_pose.h"

#include <map>
#include <set>
#include <string>

namespace fathom {

// <origin .../> of a pose.
std::string urdfOrigin(const Pose& pose);
// A number for an attribute, exact.
std::string urdfNumber(double value);

class MjcfGeoms {
public:
    MjcfGeoms(const MjcfClasses& classes, const MjcfAngles& angles, const tinyxml2::XMLElement& root);

    // <collision> or <visual> of a geom; at: pose of its frame in the link. Throws BadInput.
    std::string shape(const tinyxml2::XMLElement& geom, const std::string& childClass, const Pose& at);
    // Primitives so far that MuJoCo fits to a mesh; here the mesh takes their place.
    int fitted() const { return fitted_; }

private:
    struct Mesh {
        std::string file;
        std::string scale; // empty = 1 1 1
    };
    // A capsule, cylinder, box or ellipsoid between two points: its pose and its half length.
    struct Between {
        Pose pose;
        double half;
    };

    std::string geometry(const tinyxml2::XMLElement& geom, const std::string& childClass, const double* half);
    std::string meshGeometry(const tinyxml2::XMLElement& geom, const std::string& childClass) const;

    const MjcfClasses& classes_;
    const MjcfAngles& angles_;
    std::set<std::string> paired_; // geoms of <contact><pair>
    std::map<std::string, Mesh> meshes_;
    int fitted_ = 0;
};

} // namespace fathom
