// SPDX-License-Identifier: Apache-2.0
// Writes the region spheres of one fixture set as a binary PLY file, and reads nothing back.
#pragma once

#include "engine/contact/fixtures.h"

#include <filesystem>

namespace fathom {

// The name inside --out: fixtures/NNNNNN.ply, six digits or more of the set's frame index.
std::filesystem::path fixturesFileName(int64_t frame);

// One vertex a region sphere, in the set's order: double x y z (base frame [m]: the float position added to
// the set's origin in float64), double radius [m], int class (row of Scene::fixtures), int held (1: not seen
// in this frame). Little-endian on every machine. Throws Error that names the file.
void writeFixturesPly(const std::filesystem::path& file, const Fixtures& set);

} // namespace fathom
