// SPDX-License-Identifier: Apache-2.0
// Reads a mesh file in a process of its own: the importer is a large library that broken files can crash, and
// a crash there must be a refusal here.
#pragma once

#include "engine/model/triangle_mesh.h"

#include <filesystem>
#include <string>

namespace fathom {

struct ImportedTriangles {
    TriangleMesh mesh; // in the file's units, node transforms applied; empty when `fault` is not
    std::string fault; // one line; why nothing was read
};

// A child is forked, so that no thread is needed; it has at most a minute of CPU time. Throws Error when no
// child can be made.
ImportedTriangles importTriangles(const std::filesystem::path& file);

} // namespace fathom
