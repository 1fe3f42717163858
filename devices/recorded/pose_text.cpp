// SPDX-License-Identifier: Apache-2.0
#include "devices/recorded/pose_text.h"

#include "devices/recorded/text_file.h"
#include "engine/types/error.h"
#include "engine/types/split_words.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <string>
#include <vector>

namespace fathom {

namespace {

using Numbers = std::vector<double>;
constexpr size_t kMaxLines = 40, kColumns = 4; // read; of the rows of a motion

// Of a line with at most one other word, as the name of an image; else none.
Numbers numbersOf(std::string line) {
    std::ranges::replace_if(
        line, [](char c) { return c == ',' || c == ';'; }, ' ');
    Numbers numbers;
    size_t others = 0;
    for (const std::string_view word : splitWords(line)) {
        double value = 0.0;
        const bool number = parseNumber(word, value) && std::isfinite(value);
        others += number ? 0 : 1;
        if (number) {
            numbers.push_back(value);
        }
    }
    return others > 1 ? Numbers{} : numbers;
}

// Of the first lines; blank lines and those without numbers are left out.
std::vector<Numbers> firstLines(const std::filesystem::path& file) {
    std::vector<Numbers> lines;
    try {
        DataLines all(file);
        TextLine line;
        for (size_t i = 0; i < kMaxLines && all.next(line); ++i) {
            if (line.text.starts_with("t_s,")) { // a hand path, or a table of Fathom
                return {};
            }
            if (Numbers numbers = numbersOf(line.text); !numbers.empty()) {
                lines.push_back(std::move(numbers));
            }
        }
    } catch (const Error&) { // a long line is the last one
    }
    return lines;
}

// Where in the line a pose may be, a bit for each place.
uint32_t posePlaces(const Numbers& line) {
    constexpr uint32_t kMotion = 1u << 31;
    constexpr double kMaxOff = 1e-3;
    const size_t count = line.size();
    const bool rows = count == 12 || count == 13 || count == 16 || count == 17;
    uint32_t places = rows && isMotion(std::span(line).subspan(count % kColumns)) ? kMotion : 0;
    for (size_t i = 0; (count == 17 || (count >= 7 && count <= 10)) && i + 4 <= count; ++i) {
        const double square = line[i] * line[i] + line[i + 1] * line[i + 1] + line[i + 2] * line[i + 2] +
                              line[i + 3] * line[i + 3];
        places |= std::abs(std::sqrt(square) - 1.0) < kMaxOff ? 1u << i : 0;
    }
    return places;
}

// One pose per line: all lines as long as the first one have it at one place.
bool posePerLine(const std::vector<Numbers>& lines) {
    uint32_t places = ~0u;
    size_t alike = 0;
    for (const Numbers& line : lines) {
        if (line.size() == lines[0].size()) {
            places &= posePlaces(line);
            ++alike;
        }
    }
    return alike > 1 && places != 0;
}

// Rows on lines of their own, of at least two motions; lines of other lengths may lie between.
bool posePerRows(const std::vector<Numbers>& lines) {
    std::vector<double> rows;
    for (const Numbers& line : lines) {
        if (line.size() == kColumns) {
            rows.insert(rows.end(), line.begin(), line.end());
        }
    }
    constexpr size_t kThree = 3 * kColumns;
    const auto motionAt = [&](size_t at) {
        return at + kThree <= rows.size() && isMotion(std::span(rows).subspan(at));
    };
    return motionAt(0) && (motionAt(kThree) || motionAt(kThree + kColumns));
}

} // namespace

bool isMotion(std::span<const double> rows) {
    constexpr double kMaxOff = 0.01;
    const auto row = [&](size_t i) {
        return glm::dvec3(rows[kColumns * i], rows[kColumns * i + 1], rows[kColumns * i + 2]);
    };
    bool rigid = true;
    for (size_t i = 0; i < 3; ++i) {
        const glm::dvec3 one = row(i), next = row((i + 1) % 3);
        rigid =
            rigid && std::abs(glm::length(one) - 1.0) < kMaxOff && std::abs(glm::dot(one, next)) < kMaxOff;
    }
    return rigid;
}

bool holdsPoses(const std::filesystem::path& file) {
    const std::vector<Numbers> lines = firstLines(file);
    return posePerLine(lines) || posePerRows(lines);
}

} // namespace fathom
