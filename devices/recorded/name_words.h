// SPDX-License-Identifier: Apache-2.0
// Words in the names of files and topics that may hold poses.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace fathom {

// In lower case: "gt_cameraPose2" is gt, camera, pose2.
std::vector<std::string> nameWords(std::string_view name);
// Whether these words name poses of something else than a camera: an object, a tool, a goal, a hand.
bool nameOtherThing(const std::vector<std::string>& words);

} // namespace fathom
