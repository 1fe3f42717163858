// SPDX-License-Identifier: Apache-2.0
// Lines, words and numbers of the small text files of a recording.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

namespace fathom {

// One line of a file.
struct TextLine {
    uint32_t number = 0; // from 1, as editors count
    std::string text;    // without the line end
};

// Lines that are neither blank nor comments (first character '#'), one at a time, without a byte order mark;
// the file may be of any length.
class DataLines {
public:
    static constexpr size_t kLongest = 2048; // characters

    // Throws BadInput when the file cannot be read.
    explicit DataLines(const std::filesystem::path& file);
    // False at the end. Throws BadInput for a line that is too long.
    bool next(TextLine& line);

private:
    std::string name_;
    std::ifstream in_;
    std::array<char, kLongest + 1> buffer_{};
    uint32_t number_ = 0;
};

// All lines. Throws BadInput also for more than 1 000 000 lines or 64 MiB.
std::vector<TextLine> readDataLines(const std::filesystem::path& file);

// Whole file. Throws BadInput when it cannot be read or is longer than 16 MiB.
std::string readTextFile(const std::filesystem::path& file);

std::vector<std::string_view> splitFields(std::string_view line, char between); // trimmed, empty ones kept

// Parses the whole word as a number, independent of the locale. False when it is not one; inf and nan count
// as numbers.
bool parseNumber(std::string_view word, double& value);
bool parseNumber(std::string_view word, uint32_t& value);

} // namespace fathom
