// SPDX-License-Identifier: Apache-2.0
// Sphere sets as text in the formats of other programs; sphere_sets.h reads them back bit by bit.
#pragma once

#include "engine/model/sphere_sets.h"

#include <span>
#include <string>

namespace fathom {

std::string curoboText(std::span<const LinkSpheres> sets); // collision_spheres of cuRobo, YAML
std::string xrdfText(std::span<const LinkSpheres> sets);   // XRDF 1.0 of NVIDIA Isaac, the geometry only
std::string foamText(std::span<const LinkSpheres> sets);   // foam's JSON, one entry per link

// The URDF with the spheres of `sets` in place of all collision shapes; links without a set have none.
// Everything else stays as it is. Throws BadInput for a set whose link is not in the text.
std::string spherizedText(const std::string& urdf, std::span<const LinkSpheres> sets);
// A URDF of one link.
std::string spherizedText(const LinkSpheres& set);

} // namespace fathom
