// SPDX-License-Identifier: Apache-2.0
// Reads a mesh file in a separate process (reader_process.h).
#pragma once

#include "engine/model/reader_process.h"
#include "engine/model/triangle_mesh.h"

#include <cstdint>
#include <filesystem>
#include <string>

namespace fathom {

// The result of that process.
struct ImportedTriangles {
    TriangleMesh mesh; // in the file's units, node transforms applied; empty when `fault` is not
    std::string fault; // one line: the reason when nothing was read
};

inline constexpr uint64_t kMaxImportedPoints = 6'000'000; // corners, and triangles, of one file

// Sent through the pipe after the fault; points and triangles follow.
struct TrianglesHeader {
    uint64_t points = 0, triangles = 0;
};

// Throws Error when no process can be made, and as refuseForeign().
ImportedTriangles importTriangles(const std::filesystem::path& file, const ReaderOptions& options = {});

} // namespace fathom
