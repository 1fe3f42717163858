// SPDX-License-Identifier: Apache-2.0
#include "devices/recorded/image_views.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <map>
#include <string>

namespace fathom {

namespace {

using FrontNumbers = std::vector<NameNumber>;
using Views = std::map<NameNumber, size_t>; // the last numbers behind one front, with the name's place

constexpr size_t kMostCameras = 8;

// YYYYMMDDHHMMSS, its last part or parts. Nothing for other digits.
std::optional<long> clockSeconds(const std::string& digits) {
    constexpr size_t kWhole = 14, kShortYear = 12, kTime = 6;
    if (digits.size() < kWhole && digits.size() != kShortYear && digits.size() != kTime) {
        return std::nullopt;
    }
    const std::string whole = digits.size() >= kWhole       ? digits.substr(digits.size() - kWhole)
                              : digits.size() == kShortYear ? "20" + digits
                                                            : "20000101" + digits;
    const auto part = [&](size_t at) { return std::stol(whole.substr(at, 2)); };
    const long century = part(0), month = part(4), day = part(6), hour = part(8), minute = part(10),
               second = part(12);
    const bool date = (century == 19 || century == 20) && month >= 1 && month <= 12 && day >= 1 && day <= 31;
    // Counters of six digits begin at 0.
    const bool time = hour < 24 && minute < 60 && second < 60 && (digits.size() != kTime || hour > 0);
    return date && time ? std::optional(((month * 31 + day) * 24 + hour) * 3600 + minute * 60 + second)
                        : std::nullopt;
}

// A clock's time in whole seconds, or seconds since 1970.
std::optional<long> secondsOf(const FrontNumbers& front) {
    constexpr size_t kUnixDigits = 10; // until 2286, beginning with 1 until 2033
    const NameNumber& last = front.back();
    if (!last.fraction.empty()) {
        return std::nullopt;
    }
    if (last.whole.size() == kUnixDigits && last.whole.front() == '1') {
        return std::stol(last.whole);
    }
    std::string digits;
    for (const NameNumber& number : front) {
        digits += std::string(number.digits - number.whole.size(), '0') + number.whole;
    }
    return clockSeconds(digits);
}

// Milliseconds, microseconds or nanoseconds since 1970.
bool isFineStamp(const NameNumber& number) {
    constexpr std::array<size_t, 3> kDigits{13, 16, 19};
    return number.whole.starts_with('1') && std::ranges::find(kDigits, number.whole.size()) != kDigits.end();
}

// A counter for the images of each second: no two cameras are in step with the seconds of a clock.
bool areSeconds(const std::map<FrontNumbers, Views>& fronts) {
    size_t steps = 0;
    for (auto at = fronts.begin(); at != std::prev(fronts.end()); ++at) {
        const auto now = secondsOf(at->first), then = secondsOf(std::next(at)->first);
        steps += now && then && *then - *now == 1 ? 1 : 0;
    }
    return 2 * steps >= fronts.size() - 1;
}

// Serial numbers: long, and no times. Some look like a time, but not all.
bool areSerials(const std::map<FrontNumbers, Views>& fronts) {
    const bool isLong = std::ranges::all_of(fronts, [](const auto& front) {
        const NameNumber& last = front.first.back();
        return last.whole.size() >= kStampDigits && !isFineStamp(last);
    });
    return isLong &&
           !std::ranges::all_of(fronts, [](const auto& front) { return secondsOf(front.first).has_value(); });
}

bool countFromStart(const Views& views) {
    size_t next = views.begin()->first.text() == "0" ? 0 : 1;
    return std::ranges::all_of(views,
                               [&](const auto& view) { return view.first.text() == std::to_string(next++); });
}

// The last numbers count the same images behind all fronts.
bool countAlike(const std::map<FrontNumbers, Views>& fronts) {
    const Views& views = fronts.begin()->second;
    const auto text = [](const auto& view) { return view.first.text(); };
    return countFromStart(views) && std::ranges::all_of(fronts, [&](const auto& front) {
               return std::ranges::equal(front.second, views, {}, text, text);
           });
}

} // namespace

std::optional<ImageViews> severalViews(const std::vector<FrontNumbers>& names) {
    std::map<FrontNumbers, Views> fronts;
    for (size_t i = 0; i < names.size(); ++i) {
        if (names[i].size() < 2) {
            return std::nullopt;
        }
        fronts[FrontNumbers(names[i].begin(), std::prev(names[i].end()))].emplace(names[i].back(), i);
    }
    // Parts of a clock's time count, too.
    if (fronts.size() < 2 || endsInClock(names.front()) || !countAlike(fronts)) {
        return std::nullopt;
    }
    const Views& views = fronts.begin()->second;
    const size_t last = views.size(), before = fronts.size();
    const bool behind = last <= std::min(kMostCameras, before) && !areSeconds(fronts);
    const bool inFront = before < last && before <= kMostCameras && areSerials(fronts);
    if (last < 2 || !(behind || inFront)) {
        return std::nullopt;
    }
    return ImageViews{views.begin()->second, std::next(views.begin())->second, last, before};
}

} // namespace fathom
