// SPDX-License-Identifier: Apache-2.0
// Words in the names of files, topics and fields.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace fathom {

// In lower case: "gt_cameraPose2" is gt, camera, pose2.
std::vector<std::string> nameWords(std::string_view name);
// Whether the text contains one of these parts.
bool containsAny(std::string_view text, std::span<const std::string_view> parts);
// Whether these words name poses of something else than a camera: an object, a tool, a goal, a hand.
bool nameOtherThing(const std::vector<std::string>& words);

} // namespace fathom
