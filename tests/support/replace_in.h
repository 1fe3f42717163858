// SPDX-License-Identifier: Apache-2.0
// Changes one place in a file.
#pragma once

#include "tests/support/scratch_folder.h"

#include <doctest/doctest.h>
#include <filesystem>
#include <string>

namespace fathom::testing {

// Replaces the first occurrence of a text, which the file must contain.
inline void replaceIn(const std::filesystem::path& file, const std::string& from, const std::string& to) {
    std::string text = textOf(file);
    const size_t at = text.find(from);
    REQUIRE(at != std::string::npos);
    put(file, text.replace(at, from.size(), to));
}

} // namespace fathom::testing
