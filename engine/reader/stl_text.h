// SPDX-License-Identifier: Apache-2.0
// Checks STL files for what Assimp drops or does not explain: it regroups the corners of facets three by
// three, does not notice that a text ends early, and knows no capital keywords, padding or empty solids.
#pragma once

#include <filesystem>
#include <string>

namespace fathom {

// The reason to reject the file; empty for one that is whole, and for any other file than an STL. instead:
// gets what to parse where the file itself is not as Assimp expects it.
std::string stlFault(const std::filesystem::path& file, std::string& instead);

} // namespace fathom
