// SPDX-License-Identifier: Apache-2.0
// What a COLLADA file states that the mesh library does not read, or reads as another shape.
#pragma once

#include <filesystem>
#include <string>

namespace fathom {

// What a file states besides its shape.
struct DaeFacts {
    double metre = 1.0; // [m] of its unit
    std::string up;     // <up_axis>, such as "Y_UP"; empty = none
    bool skin = false;  // it has a skin; poses of its joints are not applied
};

// Throws BadInput for what the library would silently read as another shape, or would read without end: units
// that are no size, fans of triangles (it loses their middle), skins whose geometry is moved first, skewed
// nodes, instances of missing elements, and nodes that instance themselves.
DaeFacts checkDae(const std::filesystem::path& file);

} // namespace fathom
