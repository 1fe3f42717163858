// SPDX-License-Identifier: Apache-2.0
// Reads OBJ files down to their vertices and faces, in the spelling that Assimp reads: it miscounts numbers
// such as .5, divides by a fourth number, and joins any line that ends with a backslash to the next one.
#pragma once

#include <filesystem>
#include <string>

namespace fathom {

// The reason to reject the file, with its line; empty for one that is whole and has only faces. plain: gets
// only `v` lines of three numbers and `f` lines of vertex numbers, in the order of the file.
std::string plainObj(const std::filesystem::path& file, std::string& plain);

} // namespace fathom
