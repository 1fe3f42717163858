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

// In the order of the name. A point between digits is a decimal point, if `decimal`.
std::vector<NameNumber> numbersIn(const std::string& name, bool decimal = true);

inline constexpr size_t kStampDigits = 9; // of seconds since 1970

// The digits behind the point of the last number of several names.
struct PointDigits {
    size_t shortest = std::string::npos, longest = 0;
    size_t front = std::string::npos; // fewest digits in front of the point
    size_t example = 0;               // which name has the shortest
    // All names have such digits, in different numbers, and none begins with 0.
    bool unpadded = false;
    bool endInZero = false; // some of several digits, which decimals without their last zeros do not
    bool oneWhole = true;   // one number in front of the point

    // A point in front of a counter, as in cam1.9 and cam1.10.
    bool count() const;
    bool mayCount() const { return oneWhole && front < kStampDigits; } // as cam1.8 and cam1.9
};
// As without names if one has no number.
PointDigits pointDigits(const std::vector<std::vector<NameNumber>>& names);

// numbersIn() of each name. A point is no decimal point where these names count behind it; nor where
// `others`, the names of images of another kind, do and these names have one number in front of the point.
std::vector<std::vector<NameNumber>> numbersInNames(const std::vector<std::string>& names,
                                                    const std::vector<std::string>& others = {});

// HH-MM-SS.
bool endsInClock(const std::vector<NameNumber>& numbers);
// A name of a date or a time of day: 6 or more digits in front of the last number, or HH-MM-SS. Only all of
// its numbers together order it.
bool isDateOrTime(const std::vector<NameNumber>& numbers);

// Sorts by name; numbers within names count as numbers: 2.png is before 10.png.
void sortByName(std::vector<std::filesystem::path>& files);

} // namespace fathom
