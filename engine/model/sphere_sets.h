// SPDX-License-Identifier: Apache-2.0
// Flat sets of spheres that other programs write, link by link: spherized URDF (foam, VAMP) and cuRobo YAML.
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

// Every <collision><geometry><sphere>, at its <origin>; other geometry is not looked at. Links without
// spheres are left out; the order is the file's names'. Throws BadInput.
std::vector<LinkSpheres> readSpherizedUrdf(const std::filesystem::path& file);

// `collision_spheres: {LINK: [{center: [x, y, z], radius: r}]}`, at the top or under robot_cfg / kinematics;
// links in the file's order. Entries with radius <= 0 are cuRobo's way to switch a sphere off and are left
// out. Throws BadInput with the line.
std::vector<LinkSpheres> readCuroboYaml(const std::filesystem::path& file);

// A tree from any kind: .sph as it is; .urdf and .yaml/.yml grouped top-down, of the link named (may be empty
// when the file has one link with spheres). Throws BadInput, which lists the links there are.
SphereTree readSphereTree(const std::filesystem::path& file, const std::string& link = "");

} // namespace fathom
