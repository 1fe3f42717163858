// SPDX-License-Identifier: Apache-2.0
// Lines of an index of one stream: a stamp and a file.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace fathom {

// One line.
struct StampedFile {
    double stamp = 0.0; // [s]
    std::filesystem::path file;
};

// False for what is no finite number.
bool parseStamp(std::string_view word, double& stamp);
// Why a line has other columns than an index; empty = they stand between spaces.
std::string columnFault(std::string_view line);
// Why this word of a line is no stamp.
std::string stampFault(std::string_view line, std::string_view word);

// The path that a line names, with the backslashes of Windows as slashes unless a file has them in its name.
std::filesystem::path pathOf(const std::filesystem::path& folder, std::string_view word);

// "t path" per line of an index in the folder. Other lines are skipped: one warning per cause shows the first
// line and counts the others. Throws BadInput for a file that cannot be read.
std::vector<StampedFile> readStampedFiles(const std::filesystem::path& folder, const char* name);

} // namespace fathom
