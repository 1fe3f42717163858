// SPDX-License-Identifier: Apache-2.0
#include "devices/recorded/name_number.h"

#include <algorithm>
#include <functional>
#include <iterator>
#include <tuple>
#include <utility>

namespace fathom {

namespace {

// Texts that compare as the names do when their numbers count as numbers.
std::string sortingText(const std::string& name, const std::vector<NameNumber>& numbers) {
    constexpr size_t kLongestName = 255; // [bytes] of Linux
    std::string text;
    size_t done = 0;
    for (const NameNumber& number : numbers) {
        text += name.substr(done, number.begin - done);
        text += std::string(kLongestName - std::min(kLongestName, number.whole.size()), '0');
        text += number.whole + "." + number.fraction;
        done = number.end;
    }
    return text + name.substr(done);
}

} // namespace

bool NameNumber::operator<(const NameNumber& other) const {
    const size_t length = whole.size(), otherLength = other.whole.size();
    return std::tie(length, whole, fraction) < std::tie(otherLength, other.whole, other.fraction);
}

std::string NameNumber::text() const {
    return (whole.empty() ? "0" : whole) + (fraction.empty() ? "" : "." + fraction);
}

std::vector<NameNumber> numbersIn(const std::string& name, bool decimal) {
    std::vector<NameNumber> numbers;
    for (size_t begin = name.find_first_of(kDigits); begin != std::string::npos;
         begin = name.find_first_of(kDigits, begin)) {
        size_t end = std::min(name.find_first_not_of(kDigits, begin), name.size());
        NameNumber number;
        number.begin = begin;
        number.digits = end - begin;
        number.whole = name.substr(begin, end - begin);
        number.whole.erase(0, number.whole.find_first_not_of('0'));
        if (decimal && end + 1 < name.size() && name[end] == '.' &&
            kDigits.find(name[end + 1]) != std::string::npos) {
            begin = end + 1;
            end = std::min(name.find_first_not_of(kDigits, begin), name.size());
            number.fraction = name.substr(begin, end - begin);
            number.fraction.erase(number.fraction.find_last_not_of('0') + 1);
        }
        number.end = end;
        numbers.push_back(std::move(number));
        begin = end;
    }
    return numbers;
}

bool PointDigits::count() const {
    return unpadded && endInZero && mayCount();
}

PointDigits pointDigits(const std::vector<std::vector<NameNumber>>& names) {
    PointDigits all;
    bool padded = false;
    for (size_t i = 0; i < names.size(); ++i) {
        if (names[i].empty()) {
            return {};
        }
        const NameNumber& number = names[i].back();
        const size_t digits = number.end - number.begin - number.digits;
        const size_t behind = digits > 0 ? digits - 1 : 0; // without the point
        const bool zero = number.fraction.size() < behind;
        padded = padded || behind == 0 || number.fraction.starts_with('0') ||
                 (number.fraction.empty() && behind > 1);
        all.endInZero = all.endInZero || (zero && behind > 1);
        all.oneWhole = all.oneWhole && number.whole == names[0].back().whole;
        all.example = behind < all.shortest ? i : all.example;
        all.shortest = std::min(all.shortest, behind);
        all.longest = std::max(all.longest, behind);
        all.front = std::min(all.front, number.digits);
    }
    all.unpadded = !padded && all.shortest < all.longest;
    return all;
}

std::vector<std::vector<NameNumber>> numbersInNames(const std::vector<std::string>& names,
                                                    const std::vector<std::string>& others) {
    const auto read = [](const std::vector<std::string>& all, bool decimal) {
        std::vector<std::vector<NameNumber>> numbers;
        std::ranges::transform(all, std::back_inserter(numbers),
                               [&](const auto& name) { return numbersIn(name, decimal); });
        return numbers;
    };
    std::vector<std::vector<NameNumber>> numbers = read(names, true);
    const PointDigits own = pointDigits(numbers);
    const bool counts = own.count() || (own.mayCount() && pointDigits(read(others, true)).count());
    return counts ? read(names, false) : numbers;
}

bool endsInClock(const std::vector<NameNumber>& numbers) {
    return numbers.size() >= 3 &&
           std::all_of(numbers.end() - 3, numbers.end(), [](const auto& n) { return n.digits == 2; });
}

bool isDateOrTime(const std::vector<NameNumber>& numbers) {
    constexpr size_t kTimeDigits = 6; // of HHMMSS
    size_t before = 0;
    for (size_t i = 0; i + 1 < numbers.size(); ++i) {
        before += numbers[i].digits;
    }
    return before >= kTimeDigits || endsInClock(numbers);
}

void sortByName(std::vector<std::filesystem::path>& files) {
    const auto lengthOf = [](const std::filesystem::path& file) { return file.stem().native().size(); };
    if (std::ranges::adjacent_find(files, std::not_equal_to<>(), lengthOf) == files.end()) {
        std::ranges::sort(files); // right for decimal and hexadecimal numbers
        return;
    }
    std::vector<std::string> names;
    std::ranges::transform(files, std::back_inserter(names),
                           [](const auto& file) { return file.stem().string(); });
    const std::vector<std::vector<NameNumber>> numbers = numbersInNames(names);
    std::vector<std::pair<std::string, std::filesystem::path>> sorted;
    for (size_t i = 0; i < files.size(); ++i) {
        sorted.emplace_back(sortingText(names[i], numbers[i]), std::move(files[i]));
    }
    std::ranges::sort(sorted);
    std::ranges::transform(sorted, files.begin(), [](auto& pair) { return std::move(pair.second); });
}

} // namespace fathom
