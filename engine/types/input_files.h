// SPDX-License-Identifier: Apache-2.0
// Remembers what this process has read as input, so that no output replaces it, under any name or link.
#pragma once

#include <filesystem>

namespace fathom {

// Any thread. Remembers device, inode and time of change; no effect when the file does not exist.
void noteInput(const std::filesystem::path& file);
// Whether the file, links followed, is one that was noted.
bool isInput(const std::filesystem::path& file);
// Throws BadInput when isInput().
void refuseInput(const std::filesystem::path& file);

} // namespace fathom
