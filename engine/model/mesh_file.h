// SPDX-License-Identifier: Apache-2.0
// Reads STL, OBJ and COLLADA meshes.
#pragma once

#include "engine/model/reader_process.h"
#include "engine/model/triangle_mesh.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace fathom {

inline constexpr size_t kLargestMesh = 512u << 20; // [bytes] of a file

// Properties that a mesh file does not state.
struct MeshOptions {
    std::optional<double> scale; // metres per file unit, on top of the unit that a .dae declares; empty = 1
    dvec3 stretch{1.0};          // additional factor per file axis, finite and not 0; a negative one mirrors
    char up = 0;                 // 'x', 'y', 'z': the file's axis that becomes +z; 0 = no rotation
    bool dropStray = false;      // drop distant pieces instead of rejecting the file
    bool keepStray = false;      // keep them, whatever their distance
    bool ofUrdf = false;         // messages advise the URDF's scale instead of the option --scale
    ReaderOptions reader;        // of the process that reads the file
};

// A mesh in metres, and facts about its file.
struct LoadedMesh {
    TriangleMesh mesh; // [m], tidy
    MeshFacts facts;
    std::string warning;            // why its unit is probably wrong; empty = none
    std::vector<std::string> notes; // what a .dae states that is not applied, or on top of --scale
};

// Node transforms are applied; a .dae's <unit> is applied, its <up_axis> is not (as ROS programs do). Throws
// BadInput for a missing or empty file, numbers that are not finite, an extent outside 1 mm .. 10 m (usually
// a wrong unit), and stray geometry unless it is dropped.
LoadedMesh loadMesh(const std::filesystem::path& file, const MeshOptions& options = {});

// "2 pieces up to 19.8 m away from the rest"
std::string strayText(const MeshFacts& facts);

} // namespace fathom
