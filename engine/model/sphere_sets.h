// SPDX-License-Identifier: Apache-2.0
// Flat sphere sets per link, as other programs write them: spherized URDF (foam, VAMP) and cuRobo YAML.
#pragma once

#include "engine/types/sphere_tree.h"

#include <filesystem>
#include <string>
#include <vector>

namespace fathom {

// The spheres of one link.
struct LinkSpheres {
    std::string link;
    std::vector<Sphere> spheres; // link frame [m]
};

// Every <collision><geometry><sphere>, at its <origin>; other geometry is ignored. Links without spheres are
// skipped; the order is that of the link names. Throws BadInput.
std::vector<LinkSpheres> readSpherizedUrdf(const std::filesystem::path& file);

// `collision_spheres: {LINK: [{center: [x, y, z], radius: r}]}`, at the top or under robot_cfg / kinematics;
// links in the file's order. Entries with radius <= 0 are skipped: cuRobo disables spheres that way. Throws
// BadInput with the line.
std::vector<LinkSpheres> readCuroboYaml(const std::filesystem::path& file);

// Loads any kind: .sph as it is; .urdf and .yaml/.yml as a top-down tree of the named link (may be empty when
// only one link has spheres). Throws BadInput that lists the available links.
SphereTree readSphereTree(const std::filesystem::path& file, const std::string& link = "");

} // namespace fathom
