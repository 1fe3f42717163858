// SPDX-License-Identifier: Apache-2.0
// Writes the region spheres of one fixture set as a binary PLY file.
#pragma once

#include "engine/contact/host_fixtures.h"

#include <filesystem>
#include <string_view>

namespace fathom {

// First bytes of every such file.
inline constexpr std::string_view kFixturesPlyStart =
    "ply\nformat binary_little_endian 1.0\ncomment region spheres, base frame, metres\n";

// File name relative to --out: fixtures/NNNNNN.ply, the frame index with at least six digits.
std::filesystem::path fixturesFileName(int64_t frame);

// One vertex per region sphere, in the order of the set: double x y z (base frame [m], float position plus
// origin in float64), double radius [m], int class (index into Scene::fixtures), int held (1 = not observed
// in this frame). Always little-endian. Throws Error that names the file.
void writeFixturesPly(const std::filesystem::path& file, const HostFixtures& set);

} // namespace fathom
