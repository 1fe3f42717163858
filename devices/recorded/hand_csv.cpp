// SPDX-License-Identifier: Apache-2.0
#include "devices/recorded/hand_csv.h"

#include "devices/recorded/small_units.h"
#include "devices/recorded/text_file.h"
#include "engine/types/error.h"
#include "engine/types/log.h"
#include "engine/types/number_text.h"
#include "engine/types/rotation_fault.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace fathom {

namespace {

constexpr std::array<std::string_view, 9> kColumns{"t_s", "x", "y", "z", "qw", "qx", "qy", "qz", "button"};
constexpr size_t kNumbers = 8;                        // all but button
constexpr double kLongest = 86400.0, kFarthest = 1e6; // [s], [m]
constexpr size_t kMaxRows = 10'000'000;               // 2.8 hours at 1 kHz

struct Row {
    const std::string& file;
    const TextLine& line;

    [[noreturn]] void refuse(std::string_view column, std::string_view value,
                             const std::string& allowed) const {
        std::string field = "line " + std::to_string(line.number);
        if (!column.empty()) {
            field += ", " + std::string(column);
        }
        throw BadInput(file, field, "'" + std::string(value.substr(0, 80)) + "'", allowed);
    }
};

// Number of columns: 8, or 9 with the button.
size_t readHeader(const Row& row) {
    const std::vector<std::string_view> names = splitFields(row.line.text, ',');
    const bool known = (names.size() == kNumbers || names.size() == kColumns.size()) &&
                       std::equal(names.begin(), names.end(), kColumns.begin());
    if (!known) {
        row.refuse("", row.line.text, "header t_s,x,y,z,qw,qx,qy,qz[,button]");
    }
    return names.size();
}

dquat unitQuaternion(const Row& row, double w, double x, double y, double z) {
    if (const std::string fault = quaternionFault({w, x, y, z}, "qw qx qy qz"); !fault.empty()) {
        row.refuse("qw..qz",
                   significant(w, 6) + "," + significant(x, 6) + "," + significant(y, 6) + "," +
                       significant(z, 6),
                   fault);
    }
    return unitOf({w, x, y, z});
}

// In any spelling: other programs write 1 as "1.0" or "1e+00".
uint32_t buttonsIn(const Row& row, std::string_view word) {
    double value = 0.0;
    if (!parseNumber(word, value) || !(value >= 0.0 && value <= 4294967295.0) || value != std::floor(value)) {
        row.refuse("button", word, "a whole number from 0 to 4294967295");
    }
    return static_cast<uint32_t>(value);
}

HandWaypoint readRow(const Row& row, size_t columns) {
    const std::vector<std::string_view> fields = splitFields(row.line.text, ',');
    if (fields.size() != columns) {
        row.refuse("", std::to_string(fields.size()) + " fields",
                   std::to_string(columns) + " as in the header");
    }
    std::array<double, kNumbers> v{};
    for (size_t i = 0; i < kNumbers; ++i) {
        if (!parseNumber(fields[i], v[i]) || !std::isfinite(v[i])) {
            row.refuse(kColumns[i], fields[i], "a finite number");
        }
    }
    if (!(std::abs(v[0]) <= kLongest)) {
        row.refuse(kColumns[0], fields[0], "seconds from the start of the run, within a day of it");
    }
    for (size_t i = 1; i < 4; ++i) {
        if (!(std::abs(v[i]) <= kFarthest)) {
            row.refuse(kColumns[i], fields[i], "metres, up to 1000 km from the origin");
        }
    }
    HandWaypoint point;
    point.t = v[0];
    point.deviceThandle.position = {v[1], v[2], v[3]};
    point.deviceThandle.rotation = unitQuaternion(row, v[4], v[5], v[6], v[7]);
    point.buttons = columns > kNumbers ? buttonsIn(row, fields[kNumbers]) : 0;
    return point;
}

// Rows that no run reaches: the next one is not later than the start.
void warnAboutEarly(const std::string& file, const std::vector<HandWaypoint>& path) {
    const auto after = std::ranges::find_if(path, [](const HandWaypoint& w) { return w.t > 0.0; });
    const auto upTo = static_cast<size_t>(after - path.begin());
    if (upTo > 1) {
        log::warn(
            "{}: {} of {} rows are not played, as t_s counts from the start of the run; the first is {} s",
            file, upTo - 1, path.size(), significant(path.front().t, 6));
    }
}

// Many rows, far apart in time but close in space, are those of a recorded hand in another unit.
void warnAboutUnit(const std::string& file, const std::vector<HandWaypoint>& path) {
    constexpr size_t kFewest = 200;                       // a script of waypoints has fewer rows
    constexpr double kSlow = 2e-3;                        // [m/s]
    constexpr double kShortest = 0.25e-3, kLongRow = 0.1; // [s] between the rows of a recorded hand
    if (path.size() < kFewest) {
        return;
    }
    double way = 0.0;
    for (size_t i = 1; i < path.size(); ++i) {
        way += glm::distance(path[i].deviceThandle.position, path[i - 1].deviceThandle.position);
    }
    const double time = path.back().t - path.front().t, row = time / static_cast<double>(path.size() - 1);
    for (const SmallUnit& unit : kSmallUnits) {
        const bool rows = row >= kShortest * unit.perSecond && row < kLongRow * unit.perSecond;
        if (rows && way > 0.0 && way < kSlow * time) {
            log::warn("{}: rows are {} s apart, and the hand moves {} m in {} s: t_s is read as seconds, but "
                      "looks like {}",
                      file, significant(row, 4), significant(way, 3), significant(time, 6), unit.name);
        }
    }
}

} // namespace

std::vector<HandWaypoint> readHandCsv(const std::filesystem::path& file) {
    const std::string name = file.string();
    DataLines lines(file);
    TextLine line;
    if (!lines.next(line)) {
        throw BadInput(name, "line 1", "nothing", "header t_s,x,y,z,qw,qx,qy,qz[,button]");
    }
    const Row row{name, line};
    const size_t columns = readHeader(row);
    std::vector<HandWaypoint> path;
    while (lines.next(line)) {
        const HandWaypoint point = readRow(row, columns);
        if (!path.empty() && !(point.t > path.back().t)) {
            row.refuse("t_s", splitFields(line.text, ',')[0],
                       "later than the previous row (" + std::to_string(path.back().t) + ")");
        }
        if (path.size() == kMaxRows) {
            row.refuse("", "one more row", std::to_string(kMaxRows) + " at most");
        }
        path.push_back(point);
    }
    if (path.empty()) {
        throw BadInput(name, "line " + std::to_string(line.number + 1), "end of file", "at least one row");
    }
    warnAboutEarly(name, path);
    warnAboutUnit(name, path);
    return path;
}

} // namespace fathom
