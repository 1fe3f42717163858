// SPDX-License-Identifier: Apache-2.0
// Names of results that overwrite nothing.
#pragma once

#include <filesystem>
#include <initializer_list>
#include <string>

namespace fathom::operate {

// The first of STEM-1, STEM-2, ... for which the folder has no file with any of these endings. The folder may
// be missing. Any thread.
std::filesystem::path unusedName(const std::filesystem::path& in, const std::string& stem,
                                 std::initializer_list<const char*> endings);

} // namespace fathom::operate
