// SPDX-License-Identifier: Apache-2.0
#include "devices/recorded/name_number.h"

#include <algorithm>
#include <functional>
#include <tuple>
#include <utility>

namespace fathom {

namespace {

// Texts that compare as the names do when their numbers count as numbers.
std::string sortingText(const std::string& name) {
    constexpr size_t kLongestName = 255; // [bytes] of Linux
    std::string text;
    size_t done = 0;
    for (const NameNumber& number : numbersIn(name)) {
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

std::vector<NameNumber> numbersIn(const std::string& name) {
    std::vector<NameNumber> numbers;
    for (size_t begin = name.find_first_of(kDigits); begin != std::string::npos;
         begin = name.find_first_of(kDigits, begin)) {
        size_t end = std::min(name.find_first_not_of(kDigits, begin), name.size());
        NameNumber number;
        number.begin = begin;
        number.digits = end - begin;
        number.whole = name.substr(begin, end - begin);
        number.whole.erase(0, number.whole.find_first_not_of('0'));
        if (end + 1 < name.size() && name[end] == '.' && kDigits.find(name[end + 1]) != std::string::npos) {
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
    std::vector<std::pair<std::string, std::filesystem::path>> sorted;
    for (std::filesystem::path& file : files) {
        sorted.emplace_back(sortingText(file.stem().string()), std::move(file));
    }
    std::ranges::sort(sorted);
    std::ranges::transform(sorted, files.begin(), [](auto& pair) { return std::move(pair.second); });
}

} // namespace fathom
