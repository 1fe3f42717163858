// SPDX-License-Identifier: Apache-2.0
// Reads a mesh file in a process of its own: the importer is a large library that broken files can crash, and
// a crash there must be a refusal here.
#pragma once

#include "engine/model/triangle_mesh.h"

#include <cstdint>
#include <filesystem>
#include <string>

namespace fathom {

struct ImportedTriangles {
    TriangleMesh mesh; // in the file's units, node transforms applied; empty when `fault` is not
    std::string fault; // one line; why nothing was read
};

inline constexpr uint64_t kMostImportMemory = uint64_t{4} << 30; // [bytes] of address space

// A child is forked, so that no thread is needed; it has at most a minute of CPU time and five minutes in
// all, and at most so much memory more than this process (no bound under a sanitizer, whose own memory is
// none). Throws Error when no child can be made.
ImportedTriangles importTriangles(const std::filesystem::path& file, uint64_t mostMemory = kMostImportMemory);

} // namespace fathom
