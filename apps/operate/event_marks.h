// SPDX-License-Identifier: Apache-2.0
// The moments of a recording that a pilot has marked: marks.csv.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace fathom::operate {

inline constexpr const char* kMarksFile = "marks.csv";
inline constexpr const char* kMarksHeader = "t_s,name";

struct EventMark {
    double t = 0.0; // [s] in the recording
    std::string name;
};

// In ascending time; empty without the file. Throws BadInput with file, line and column. At most 10000 marks.
std::vector<EventMark> readMarks(const std::filesystem::path& folder);

// Adds "mark N" at t [s] to the marks and to the file, which is replaced only when the new one is complete.
// Throws Error that names the file.
void addMark(const std::filesystem::path& folder, std::vector<EventMark>& marks, double t);

} // namespace fathom::operate
