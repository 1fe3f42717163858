// SPDX-License-Identifier: Apache-2.0
// The numbers in the names of images: counters, stamps, dates and times.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace fathom {

inline constexpr std::string_view kDigits = "0123456789"; // of numbers in names

// Of any length, which no integer type holds: stamps in nanoseconds have 19 digits.
struct NameNumber {
    std::string whole, fraction; // without leading and trailing zeros
    size_t digits = 0;           // in front of the decimal point, leading zeros included
    size_t begin = 0, end = 0;   // place in the name

    bool operator<(const NameNumber& other) const;
    std::string text() const;
};

// In the order of the name. A point between digits is a decimal point.
std::vector<NameNumber> numbersIn(const std::string& name);

// HH-MM-SS.
bool endsInClock(const std::vector<NameNumber>& numbers);
// A name of a date or a time of day: 6 or more digits in front of the last number, or HH-MM-SS. Only all of
// its numbers together order it.
bool isDateOrTime(const std::vector<NameNumber>& numbers);

// Sorts by name; numbers within names count as numbers: 2.png is before 10.png.
void sortByName(std::vector<std::filesystem::path>& files);

} // namespace fathom
