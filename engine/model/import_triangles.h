// SPDX-License-Identifier: Apache-2.0
// Reads a mesh file in a separate process (reader_process.h).
#pragma once

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

inline constexpr uint64_t kMostImportMemory = uint64_t{4} << 30; // [bytes] of address space

// Throws Error when no process can be made.
ImportedTriangles importTriangles(const std::filesystem::path& file, uint64_t mostMemory = kMostImportMemory);

} // namespace fathom
