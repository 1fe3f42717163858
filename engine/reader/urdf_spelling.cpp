// SPDX-License-Identifier: Apache-2.0
#include "engine/reader/urdf_spelling.h"

#include "engine/model/xml_text.h"
#include "engine/types/error.h"
#include "engine/types/joined.h"
#include "engine/types/lower_case.h"
#include "engine/types/printable.h"
#include "engine/types/suggestion.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <span>
#include <sstream>

namespace fathom {

namespace {

using Words = std::vector<std::string_view>;

// What urdfdom reads in an element, and whether it is all that the element may have: extensions are common
// elsewhere.
struct Readable {
    Words names;
    bool nothingElse = false;
};

// Children that are read, by the path of the element. `single`: only the first of each is read.
struct Children {
    Words names, single;
};

const std::map<std::string_view, Children>& childrenRead() {
    static const Words kOfJoint{"origin", "parent", "child", "axis", "limit", "mimic"};
    static const std::map<std::string_view, Children> kAll{
        {"robot", {{"link", "joint"}, {}}},
        {"robot/joint", {kOfJoint, kOfJoint}},
        {"robot/link", {{"collision"}, {}}},
        {"robot/link/collision", {{"origin", "geometry"}, {"origin"}}}};
    return kAll;
}

const std::map<std::string_view, Readable>& attributesRead() {
    static const Readable kOrigin{{"xyz", "rpy"}, true};
    static const std::map<std::string_view, Readable> kAll{
        {"robot/joint/origin", kOrigin},
        {"robot/joint/mimic", {{"joint", "multiplier", "offset"}, true}},
        {"robot/joint/axis", {{"xyz"}}},
        {"robot/joint/limit", {{"lower", "upper", "effort", "velocity"}}},
        {"robot/link/collision/origin", kOrigin},
        {"robot/link/collision/geometry/mesh", {{"filename", "scale"}}}};
    return kAll;
}

// The word that was probably meant; empty = none. Names with '_' or ':' are extensions, such as
// k_velocity.
std::string_view correctionOf(std::string_view written, const Words& words) {
    if (std::ranges::find(words, written) != words.end()) {
        return "";
    }
    const auto same = std::ranges::find(words, lowerCase(std::string(written)));
    const bool extension = written.find_first_of("_:") != std::string_view::npos;
    return same != words.end() ? *same : extension ? std::string_view{} : nearestWord(written, words);
}

// The element that other formats, or the plural, call so.
std::string_view otherName(std::string_view path, std::string_view name) {
    const bool place = name == "pose" || name == "position" || name == "rotation";
    return path == "robot/joint" && place                      ? "origin"
           : path == "robot/link" && name == "collision_group" ? "collision"
                                                               : "";
}

class Speller {
public:
    Speller(const std::string& file, std::vector<std::string>& notes)
        : file_(file)
        , notes_(notes) {}

    void check(std::string_view path, const XmlPiece& tag) {
        const bool part = path == "robot" && (tag.name == "link" || tag.name == "joint");
        if (part) {
            part_ = tag.name;
            part_ += ' ';
            part_ += printable(xmlAttribute(tag.text, "name"));
        }
        if (part || (path == "robot/link" && tag.name == "collision")) {
            first_.clear();
        }
        checkChild(path, tag);
        checkPlace(path, tag);
        std::string own(path);
        own += '/';
        own += tag.name;
        checkAttributes(own, tag);
        if (own == "robot/joint/origin" || own == "robot/link/collision/origin") {
            noteTurn(xmlAttribute(tag.text, "rpy"));
        } else if (own == "robot/joint/limit") {
            noteHalf(tag);
        }
    }

private:
    [[noreturn]] void refuse(std::string_view path, const std::string& value,
                             const std::string& allowed) const {
        throw BadInput(file_, path == "robot" ? "robot" : part_, value, allowed);
    }

    // <name>, or <name more>
    static std::string quoted(std::string_view name, std::string_view more = "") {
        std::string out = "<";
        out += printable(std::string(name));
        out += more.empty() ? "" : " ";
        out += printable(std::string(more));
        return out += ">";
    }

    void checkChild(std::string_view path, const XmlPiece& tag) {
        const auto known = childrenRead().find(path);
        if (known == childrenRead().end()) {
            return;
        }
        const std::string_view other = otherName(path, tag.name);
        const std::string_view meant = other.empty() ? correctionOf(tag.name, known->second.names) : other;
        if (!meant.empty()) {
            refuse(path, quoted(tag.name) + ": not read", quoted(meant));
        }
        if (std::ranges::find(known->second.single, tag.name) != known->second.single.end()) {
            checkRepeated(path, tag);
        }
    }

    void checkRepeated(std::string_view path, const XmlPiece& tag) {
        std::map<std::string, std::string> values;
        for (const std::string_view name : xmlAttributeNames(tag.text)) {
            values[std::string(name)] = xmlAttribute(tag.text, name);
        }
        const auto [first, isNew] = first_.emplace(tag.name, values);
        if (!isNew && first->second != values) {
            refuse(path, "several " + quoted(tag.name) + " that differ", "one " + quoted(tag.name));
        }
    }

    // Links and joints in an element of the robot that urdfdom skips, and collisions beside their place.
    void checkPlace(std::string_view path, const XmlPiece& tag) const {
        const size_t slash = path.rfind('/');
        const std::string_view holder = slash == std::string_view::npos ? path : path.substr(slash + 1);
        const bool inside = path.starts_with("robot/") && path.find('/', 6) == std::string_view::npos;
        const bool foreign = holder == "gazebo" || holder == "transmission" || holder == "sensor" ||
                             holder == "ros2_control" || holder.find(':') != std::string_view::npos;
        // Groups of semantic descriptions only name links and joints.
        const bool link = tag.name == "link" && !tag.isEmpty,
                   joint = tag.name == "joint" && !xmlAttribute(tag.text, "type").empty();
        if (inside && !foreign && (link || joint)) {
            refuse("robot", quoted(tag.name) + " in " + quoted(holder) + ": not read",
                   quoted(tag.name) + " in <robot>");
        }
        if ((path == "robot/link/visual" || path == "robot/link/inertial") && tag.name == "collision") {
            refuse(path, "<collision> in " + quoted(holder) + ": not read", "<collision> in <link>");
        }
        if (path == "robot/link/collision/geometry" && tag.name == "origin") {
            refuse(path, "<origin> in <geometry>: not read", "<origin> in <collision>");
        }
    }

    void checkAttributes(const std::string& own, const XmlPiece& tag) const {
        const auto known = attributesRead().find(own);
        if (known == attributesRead().end()) {
            return;
        }
        const Words& names = known->second.names;
        for (const std::string_view name : xmlAttributeNames(tag.text)) {
            const bool unread = known->second.nothingElse && name.find(':') == std::string_view::npos &&
                                std::ranges::find(names, name) == names.end();
            if (unread || !correctionOf(name, names).empty()) {
                refuse(own, quoted(tag.name, std::string(name) + "=...") + ": not read",
                       joined(std::span(names)));
            }
        }
    }

    void noteTurn(const std::string& rpy) {
        std::istringstream words(rpy);
        for (double angle = 0.0; words >> angle;) {
            if (std::abs(angle) > 2.0 * std::numbers::pi + 0.01) { // no origin of 500 public URDFs has more
                notes_.push_back(part_ + ": rpy " + excerpt(printable(rpy)) +
                                 " is more than a turn; in degrees?");
                return;
            }
        }
    }

    void noteHalf(const XmlPiece& tag) {
        const bool lower = !xmlAttribute(tag.text, "lower").empty(),
                   upper = !xmlAttribute(tag.text, "upper").empty();
        if (lower != upper) {
            notes_.push_back(part_ + ": <limit> has no " + (lower ? "upper" : "lower") + ", which is 0 then");
        }
    }

    const std::string& file_;
    std::vector<std::string>& notes_;
    std::string part_; // "joint NAME" or "link NAME", the last one that began
    std::map<std::string_view, std::map<std::string, std::string>> first_; // of its single elements
};

} // namespace

void checkSpelling(const std::string& text, const std::string& file, std::vector<std::string>& notes) {
    Speller speller(file, notes);
    for (XmlTags tags(text); tags.next();) {
        speller.check(tags.path(), tags.tag());
    }
}

} // namespace fathom
