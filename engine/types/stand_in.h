// SPDX-License-Identifier: Apache-2.0
// Files that hold something else in place of their content: pointers of clones, pages of failed downloads,
// archives.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace fathom {

// What begins so in place of a file that programs read, with the remedy, for messages; empty for other bytes.
// begin: at least the first 262 bytes where there are as many.
std::string standIn(std::string_view begin);
// The same for a file; empty where it cannot be read.
std::string standInOf(const std::filesystem::path& file);
// Throws BadInput for such a file. kind: the allowed kind of file, "a ROS bag".
void refuseStandIn(const std::filesystem::path& file, const std::string& kind);
// Throws BadInput for text that begins with a byte order mark of UTF-16, for readers of UTF-8 alone. begin:
// the file's first bytes.
void refuseUtf16(const std::filesystem::path& file, std::string_view begin, const std::string& kind);

} // namespace fathom
