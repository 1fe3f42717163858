// SPDX-License-Identifier: Apache-2.0
// Files that are given as a robot and are none.
#pragma once

#include <filesystem>
#include <string>

namespace fathom {

// Throws BadInput for files that belong to a robot, describe one in another form, or are no XML: says what
// the file is and what to give instead.
void refuseOtherKinds(const std::filesystem::path& file, const std::string& text);

} // namespace fathom
