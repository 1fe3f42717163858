// SPDX-License-Identifier: Apache-2.0
// The worlds of the cases, each with a tool and a start pose: synthetic clouds of region spheres, images of
// analytic scenes, and recordings.
#pragma once

#include "apps/stability/random_hand.h"
#include "engine/contact/host_fixtures.h"
#include "engine/contact/tool.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace fathom::stability {

inline const dquat kUpright(1.0, 0.0, 0.0, 0.0);

struct World {
    std::string name;
    HostFixtures fixtures;
    std::vector<Sphere> leaves; // of the tool
    Pose start;                 // base_T_tool outside every region
    dvec3 focus{0.0};           // [m] base frame: centre of the hand's motion
    double arena = 0.15;        // [m] half edge of the cube around focus
};

Tool toolOf(const std::vector<Sphere>& leaves);
Tool ballTool(double radius);

// A rod of overlapping balls with a cross bar, 60 mm each, for cases in which rotation matters.
std::vector<Sphere> crossLeaves(double radius);

// Square patch of the plane spanned by the unit vectors u and v, with a sphere every `spacing` [m].
void addWall(HostFixtures& set, const dvec3& centre, const dvec3& u, const dvec3& v, double half,
             double spacing, double radius);
// Copy with the whole scene moved by `way` in the base frame. Coordinates relative to the local origin stay
// the same.
World movedBy(const World& world, const dvec3& way);

World wallWorld();
World cornerWorld(); // concave, three walls
World slotWorld();   // 1 mm of clearance on each side of a 10 mm ball
World grooveWorld(double degrees);
World needleWorld(); // spikes of 0.1 to 0.2 mm and a tool of 0.5 mm
World rubbleWorld(); // 1500 balls of 2 to 20 mm

// One frame of the simulated camera at 160 x 120 pixels, with optional noise and regions of `radius` [m].
World analyticWorld(const std::string& scene, double radius, bool noise);

// First frame of a recording, classified by the scene file. Empty when the folder is missing.
std::optional<World> recordedWorld(const std::string& sceneFile, const std::string& folder);
// Folder of a recording, relative to the folder in which the program starts.
std::filesystem::path recordingFolder(const std::string& name);

} // namespace fathom::stability
