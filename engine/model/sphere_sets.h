// SPDX-License-Identifier: Apache-2.0
// Flat sphere sets per link, as other programs write them: spherized URDF (foam, VAMP), YAML of cuRobo, XRDF
// of NVIDIA Isaac, and JSON of foam.
#pragma once

#include "engine/model/reader_process.h"
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

// Adds a distance to the radii as cuRobo does: a radius of -1 or less disables a sphere, and others have at
// least 1 mm. Warns if all are disabled. file: for the message.
void growSpheres(const std::filesystem::path& file, LinkSpheres& set, double distance);

// For messages, with commas, cut where there are too many.
std::string namesOf(const std::vector<LinkSpheres>& sets);

// Every <collision><geometry><sphere>, at its <origin>, in the order of the link names. Links without shapes
// are skipped. Throws BadInput, also for a shape that is no sphere, of any link or of the named one.
std::vector<LinkSpheres> readSpherizedUrdf(const std::filesystem::path& file, const std::string& link = "",
                                           const ReaderOptions& reader = {});

// XRDF: `geometry: {NAME: {spheres: {LINK: [...]}}}`, NAME from `collision: {geometry: NAME}` or the only
// one; `collision: {buffer_distance: {LINK: d}}` is added to the radii, see growSpheres(). Throws
// BadInput with the line.
std::vector<LinkSpheres> readXrdf(const std::filesystem::path& file);

// XRDF if the file says `format: xrdf`. Otherwise cuRobo's `collision_spheres: {LINK: [{center: [x, y, z],
// radius: r}]}`, at the top or under robot_cfg / kinematics, or a list of such tables as in Lula's files;
// links in the file's order. `collision_sphere_buffer` next to it, one distance or {LINK: d}, is added to the
// radii, see growSpheres(). Throws BadInput with the line.
std::vector<LinkSpheres> readYamlSets(const std::filesystem::path& file);

// JSON of foam: {"LINK::anything": {"spheres": [{"origin": [x, y, z], "radius": r}]}}, or one such table, or
// a list of them as for one mesh, whose last one counts; these belong to a link named as the file. JSON with
// the keys of cuRobo is read as such. Throws BadInput.
std::vector<LinkSpheres> readFoam(const std::filesystem::path& file);

// Whether readSets() knows the file's ending: .sph, .urdf, .yaml, .yml, .xrdf, .json.
bool isSphereFile(const std::filesystem::path& file);

// Any kind; a .yaml with `format: xrdf` is XRDF. A .sph gives the leaves of its tree, as a link named as the
// file. Only the named link, or all without a name. Throws BadInput, also when there is no sphere.
std::vector<LinkSpheres> readSets(const std::filesystem::path& file, const std::string& link = "",
                                  const ReaderOptions& reader = {});

// Only the named link; all of them without a name. Throws BadInput that lists the available links.
std::vector<LinkSpheres> selectLink(std::vector<LinkSpheres> sets, const std::string& link,
                                    const std::filesystem::path& file);

// Loads any kind: .sph as it is, without a link; the others as a top-down tree of the named link (may be
// empty when only one link has spheres). Throws BadInput that lists the available links.
SphereTree readSphereTree(const std::filesystem::path& file, const std::string& link = "",
                          const ReaderOptions& reader = {});

} // namespace fathom
