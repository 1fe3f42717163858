// SPDX-License-Identifier: Apache-2.0
#include "devices/recorded/pose_track.h"

#include "devices/recorded/small_units.h"
#include "devices/recorded/text_file.h"
#include "engine/types/error.h"
#include "engine/types/log.h"
#include "engine/types/printed.h"
#include "engine/types/rotation_fault.h"
#include "engine/types/split_words.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <fstream>
#include <limits>

namespace fathom {

namespace {

// Words of letters, digits, '_' and '.', in lower case, without units ("[m]", "(s)", "[]") and without the
// names of groups of columns.
std::vector<std::string> headWords(const std::string& comment) {
    constexpr std::array<std::string_view, 10> kGroups{
        "position", "pos", "translation", "orientation", "rotation", "rot", "quaternion", "quat", "q", "and"};
    std::vector<std::string> words{""};
    for (size_t i = 0; i < comment.size(); ++i) {
        const char c = comment[i];
        const size_t end = c == '[' || c == '(' ? comment.find_first_of("]), ;", i + 1) : std::string::npos;
        if (end != std::string::npos && (comment[end] == ']' || comment[end] == ')')) {
            i = end;
        } else if (const auto byte = static_cast<unsigned char>(c);
                   std::isalnum(byte) != 0 || c == '_' || c == '.') {
            words.back() += static_cast<char>(std::tolower(byte));
            continue;
        }
        if (!words.back().empty()) {
            words.emplace_back();
        }
    }
    std::erase_if(words, [&](const std::string& word) {
        return word.empty() || std::ranges::find(kGroups, word) != kGroups.end();
    });
    return words;
}

// What a word may name: "tx", "pos_x" and "p_RS_R_x" a position, "qx", "quat_x" and "q.x" a quaternion, "x"
// both.
struct ColumnName {
    char axis = 0; // w to z; else the word names neither
    bool bare = false, position = false, quaternion = false;
};

ColumnName columnNamed(std::string_view word) {
    constexpr std::string_view kJoints = "_.";
    while (word.ends_with('.')) { // the end of a sentence
        word.remove_suffix(1);
    }
    const char axis = word.empty() ? '\0' : word.back();
    if (axis < 'w' || axis > 'z') {
        return {};
    }
    word.remove_suffix(1);
    const bool bare = word.empty(), joined = !bare && kJoints.find(word.back()) != std::string_view::npos;
    const auto has = [&](std::string_view part) { return word.find(part) != std::string_view::npos; };
    const bool turn = word.starts_with('q') || has("quat") || has("orient") || has("rot");
    const bool place = !turn && (word.size() <= 2 || joined || word.starts_with("pos"));
    return {axis, bare, place, turn || bare};
}

// The axes of `count` names from `at` on, if each axis is there once; else empty.
std::string axesOf(const std::vector<ColumnName>& names, size_t at, size_t count, bool quaternion) {
    std::string axes;
    for (size_t i = at; i < at + count && i < names.size(); ++i) {
        const ColumnName& name = names[i];
        const bool fits = quaternion ? name.quaternion && name.bare == names[at].bare : name.position;
        axes += fits ? name.axis : ' ';
    }
    return std::ranges::is_permutation(axes, quaternion ? std::string("xyzw") : std::string("xyz")) ? axes
                                                                                                    : "";
}

enum class Order { Unnamed, Own, Other };

// The last order of the columns that a comment names: those of a quaternion next to those of a position.
Order orderNamed(const std::string& comment) {
    std::vector<ColumnName> names;
    for (const std::string& word : headWords(comment)) {
        names.push_back(columnNamed(word));
    }
    Order order = Order::Unnamed;
    for (size_t i = 0; i + 4 <= names.size(); ++i) {
        const std::string turn = axesOf(names, i, 4, true);
        const std::string before = i >= 3 ? axesOf(names, i - 3, 3, false) : "";
        if (turn == "xyzw" && before == "xyz") {
            order = Order::Own;
        } else if (!turn.empty() && (!before.empty() || !axesOf(names, i + 4, 3, false).empty())) {
            order = Order::Other;
        }
    }
    return order;
}

// Comments in front of the first pose may name the columns. The last order that they name counts: one before
// it is that of an earlier file.
void checkOrder(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    std::array<char, DataLines::kLongest + 1> line{};
    std::string field, other;
    for (uint32_t number = 1; number < 100 && in.getline(line.data(), line.size()); ++number) {
        const std::string text = line.data();
        const size_t first = text.find_first_not_of(" \t\r\xef\xbb\xbf"); // also a byte order mark
        if (first == std::string::npos) {
            continue;
        }
        const Order order = text[first] == '#' ? orderNamed(text) : Order::Unnamed;
        if (text[first] != '#') {
            break;
        }
        if (order != Order::Unnamed) {
            field = "line " + std::to_string(number);
            other = order == Order::Other ? text.substr(0, 160) : "";
        }
    }
    if (!other.empty()) {
        throw BadInput(file.string(), field, other, "columns in the order t tx ty tz qx qy qz qw");
    }
}

} // namespace

PoseTrack::PoseTrack(const std::filesystem::path& file) {
    checkOrder(file);
    for (const TextLine& line : readDataLines(file)) {
        const auto refuse = [&](const std::string& allowed) {
            throw BadInput(file.string(), "line " + std::to_string(line.number), line.text.substr(0, 160),
                           allowed);
        };
        const std::vector<std::string_view> words = splitWords(line.text);
        std::array<double, 8> v{};
        bool good = words.size() == v.size();
        for (size_t i = 0; good && i < v.size(); ++i) {
            good = parseNumber(words[i], v[i]) && std::isfinite(v[i]);
        }
        if (!good) {
            refuse("eight finite numbers t tx ty tz qx qy qz qw, with decimal points and between spaces");
        }
        const dquat q(v[7], v[4], v[5], v[6]);
        if (const std::string fault = quaternionFault(q, "qx qy qz qw"); !fault.empty()) {
            refuse(fault);
        }
        if (!(std::max({std::abs(v[1]), std::abs(v[2]), std::abs(v[3])}) <= kFarthestPose)) {
            refuse("a position within 1000 km of the origin");
        }
        if (!poses_.empty() && !(v[0] > poses_.back().t)) {
            refuse("a time later than in the previous line");
        }
        // A unit quaternion stays as it is, so that a track that was written is read with the same bits.
        constexpr double kUnit = 4.0 * std::numeric_limits<double>::epsilon();
        const double length = glm::length(q);
        poses_.push_back({v[0], {{v[1], v[2], v[3]}, std::abs(length - 1.0) <= kUnit ? q : q / length}});
    }
    warnIfFast(file);
    if (poses_.empty()) {
        throw BadInput(file.string(), "poses", "none", "at least one line t tx ty tz qx qy qz qw");
    }
}

// Warns once about a camera that is faster than any is moved.
void PoseTrack::warnIfFast(const std::filesystem::path& file) const {
    constexpr double kFar = 0.1, kFast = 10.0; // [m], [m/s]
    for (size_t i = 1; i < poses_.size(); ++i) {
        const double way = glm::distance(poses_[i].baseTcamera.position, poses_[i - 1].baseTcamera.position);
        const double time = poses_[i].t - poses_[i - 1].t;
        if (way > kFar && way > kFast * time) {
            log::warn("{}: at {:.6f} s the camera moves {:.4g} m in {:.4g} s (millimetres, other seconds, or "
                      "a jump of "
                      "the tracking?)",
                      file.string(), poses_[i].t, way, time);
            return;
        }
    }
}

std::vector<PoseTrack::Stamped>::const_iterator PoseTrack::after(double t) const noexcept {
    return std::ranges::upper_bound(poses_, t, {}, &Stamped::t);
}

std::optional<Pose> PoseTrack::at(double t) const noexcept {
    constexpr double kSlack = 1e-6; // [s] rounding of stamps since 1970
    const auto next = after(t);
    const bool hasBefore = next != poses_.begin(), hasNext = next != poses_.end();
    if (hasBefore && hasNext && next->t - (next - 1)->t <= kLongestGap + kSlack) {
        const Stamped& before = *(next - 1);
        if (t == before.t) {
            return before.baseTcamera;
        }
        return interpolate(before.baseTcamera, next->baseTcamera, (t - before.t) / (next->t - before.t));
    }
    const double since = hasBefore ? t - (next - 1)->t : HUGE_VAL, until = hasNext ? next->t - t : HUGE_VAL;
    if (!(std::min(since, until) <= kNear + kSlack)) {
        return std::nullopt;
    }
    return since <= until ? (next - 1)->baseTcamera : next->baseTcamera;
}

// Which of two clocks may be in a unit below seconds, " (poses in nanoseconds?)"; empty = none. Only for long
// times, as those since 1970: short ones may be anything.
std::string PoseTrack::unitHint(double t) const {
    constexpr double kShort = 1e3, kApart = 60.0; // [s]
    const double first = poses_.front().t, last = poses_.back().t;
    for (const SmallUnit& unit : kSmallUnits) {
        const double asSeconds = t / unit.perSecond;
        if (first > kShort && asSeconds > first - kApart && asSeconds < last + kApart) {
            return std::string(" (stamps of images in ") + unit.name + "?)";
        }
        if (t > kShort && t > first / unit.perSecond - kApart && t < last / unit.perSecond + kApart) {
            return std::string(" (stamps of poses.txt in ") + unit.name + "?)";
        }
    }
    return "";
}

std::string PoseTrack::whyNone(double t) const {
    const auto next = after(t);
    const std::string where = next == poses_.begin() ? printed("%.3f s before the first pose", next->t - t)
                              : next == poses_.end()
                                  ? printed("%.3f s after the last pose", t - poses_.back().t)
                                  : printed("in a gap of %.3f s", next->t - (next - 1)->t);
    return printed("its stamp %.3f s is ", t) + where + " of poses.txt" + unitHint(t);
}

} // namespace fathom
