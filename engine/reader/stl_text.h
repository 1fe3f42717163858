// SPDX-License-Identifier: Apache-2.0
// Checks STL files in text for what Assimp drops: it regroups the corners of facets three by three, and does
// not notice that a file ends early.
#pragma once

#include <filesystem>
#include <string>

namespace fathom {

// The reason to reject the file; empty for one that is whole, and for any other file than an STL in text.
std::string textStlFault(const std::filesystem::path& file);

} // namespace fathom
