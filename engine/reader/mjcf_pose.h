// SPDX-License-Identifier: Apache-2.0
// Poses of MJCF elements: pos with quat, axisangle, euler, xyaxes or zaxis.
#pragma once

#include "engine/reader/mjcf_class.h"
#include "engine/types/pose.h"

#include <optional>

namespace fathom {

// How the file states angles (<compiler>).
struct MjcfAngles {
    double perUnit = 0.017453292519943295; // [rad] of an angle's unit: degrees, or 1
    std::string eulerOrder = "xyz";        // three of xyzXYZ; lower case: about axes that turn along
};

// Throws BadInput for another value of angle or eulerseq.
MjcfAngles mjcfAngles(const MjcfClasses& classes, const tinyxml2::XMLElement& root);

// Of the element in its parent's frame; the identity where nothing is stated.
Pose mjcfPose(const MjcfClasses& classes, const MjcfAngles& angles, const tinyxml2::XMLElement& element,
              const std::string& childClass);

// Pose of a geom or site. `half`: half of the length of its fromto [m].
struct MjcfShapePose {
    Pose pose;
    std::optional<double> half;
};

// mjcfPose(); with fromto, as MuJoCo places it: in the middle, z leading from the second point to the first.
// Throws BadInput for points that coincide.
MjcfShapePose mjcfShapePose(const MjcfClasses& classes, const MjcfAngles& angles,
                            const tinyxml2::XMLElement& element, const std::string& childClass);

// A turn that takes +z to the direction, which must not be zero.
dquat turnOfZ(const dvec3& direction);

} // namespace fathom
