// SPDX-License-Identifier: Apache-2.0
#include "engine/reader/control_joints.h"

#include "engine/model/xml_text.h"
#include "engine/types/number_text.h"
#include "engine/types/printable.h"

#include <algorithm>
#include <cmath>
#include <locale>
#include <memory>
#include <optional>
#include <set>
#include <sstream>
#include <string_view>
#include <utility>

namespace fathom {

namespace {

constexpr double kSameTie = 1e-6;  // difference of numbers that were rounded
constexpr double kNarrower = 2e-3; // of a joint's range; less is a rounded limit, such as 3.14 for pi

// A joint that follows another one; multiplier and offset as in the file, empty = none.
struct StatedMimic {
    std::string joint, leader, multiplier, offset, place, follower; // follower: <jointName> of a plugin
    bool directed = true;                                           // it is known which of the two follows
};

std::optional<double> finiteNumber(const std::string& text) {
    std::istringstream in(text);
    in.imbue(std::locale::classic());
    double value = 0.0;
    if (!(in >> value) || !(in >> std::ws).eof() || !std::isfinite(value)) {
        return {};
    }
    return value;
}

// Where a child of the element keeps its text; null = it states nothing of a mimic.
std::string* fieldOf(StatedMimic& mimic, std::string_view path, const XmlPiece& tag) {
    const bool plugin = path == "robot/gazebo/plugin";
    if (!plugin && !(path == "robot/ros2_control/joint" && tag.name == "param")) {
        return nullptr;
    }
    const std::string key = plugin ? std::string(tag.name) : xmlAttribute(tag.text, "name");
    return plugin && key == "mimicJoint"         ? &mimic.joint
           : key == (plugin ? "joint" : "mimic") ? &mimic.leader
           : plugin && key == "jointName"        ? &mimic.follower
           : key == "multiplier"                 ? &mimic.multiplier
           : key == "offset"                     ? &mimic.offset
                                                 : nullptr;
}

std::vector<StatedMimic> statedMimics(const std::string& text) {
    std::vector<StatedMimic> all;
    for (XmlTags tags(text); tags.next();) {
        const XmlPiece& tag = tags.tag();
        if (tags.path() == "robot/ros2_control" && tag.name == "joint") {
            all.push_back({xmlAttribute(tag.text, "name"), "", "", "", "<ros2_control>"});
        } else if (tags.path() == "robot/gazebo" && tag.name == "plugin") {
            const bool known = xmlAttribute(tag.text, "filename").find("roboticsgroup") != std::string::npos;
            all.push_back({"", "", "", "", "a plugin of <gazebo>", "", known});
        } else if (std::string* const field = all.empty() ? nullptr : fieldOf(all.back(), tags.path(), tag)) {
            *field = tags.content();
        }
    }
    for (StatedMimic& mimic : all) {
        if (!mimic.follower.empty()) { // Care-O-bot
            mimic.leader = std::exchange(mimic.joint, mimic.follower);
            mimic.directed = true;
        }
    }
    std::erase_if(all, [](const StatedMimic& mimic) { return mimic.joint.empty() || mimic.leader.empty(); });
    return all;
}

std::string textOf(const urdf::JointMimic& mimic) {
    return "follows " + excerpt(printable(mimic.joint_name)) + ", multiplier " +
           significant(mimic.multiplier, 6) + ", offset " + significant(mimic.offset, 6);
}

bool areSame(const urdf::JointMimic& a, const urdf::JointMimic& b) {
    return a.joint_name == b.joint_name && std::abs(a.multiplier - b.multiplier) <= kSameTie &&
           std::abs(a.offset - b.offset) <= kSameTie;
}

class MimicAdder {
public:
    MimicAdder(urdf::ModelInterface& model, std::vector<std::string>& notes)
        : model_(model)
        , notes_(notes) {}

    void add(const StatedMimic& stated) {
        const std::string name = "joint " + excerpt(printable(stated.joint));
        const std::string all = stated.joint + stated.leader + stated.multiplier + stated.offset;
        const auto found = model_.joints_.find(stated.joint);
        if (all.find("${") != std::string::npos || all.find("$(") != std::string::npos) {
            notes_.push_back(name + ": its mimic in " + stated.place + " is not expanded and not read");
        } else if (found == model_.joints_.end()) {
            notes_.push_back(name + ": its mimic in " + stated.place +
                             " is not used: the robot has no such joint");
        } else if (const auto leader = model_.joints_.find(stated.leader); leader == model_.joints_.end()) {
            notes_.push_back(name + ": its mimic in " + stated.place +
                             " is not used: the robot has no joint " + excerpt(printable(stated.leader)));
        } else if (!stated.directed) {
            if (!found->second->mimic && !leader->second->mimic) {
                notes_.push_back(name + ": its tie to " + excerpt(printable(stated.leader)) + " in " +
                                 stated.place + " is not used: the file does not say which one follows");
            }
        } else if (found->second->type != urdf::Joint::FIXED) {
            tie(*found->second, stated, name);
        }
    }

private:
    void tie(urdf::Joint& joint, const StatedMimic& stated, const std::string& name) {
        const auto multiplier = numberOr(stated.multiplier, 1.0), offset = numberOr(stated.offset, 0.0);
        if (!multiplier || !offset) {
            notes_.push_back(name + ": its mimic in " + stated.place + " is not used: '" +
                             excerpt(printable(multiplier ? stated.offset : stated.multiplier)) +
                             "' is no finite number");
            return;
        }
        const auto made = std::make_shared<urdf::JointMimic>();
        made->joint_name = stated.leader;
        made->multiplier = *multiplier;
        made->offset = *offset;
        const std::string own = stated.place + " (" + textOf(*made) + ")";
        if (joint.mimic && !areSame(*joint.mimic, *made)) {
            notes_.push_back(
                name + ": its mimic in " + own + " is not used: " +
                (added_.count(joint.name) == 0 ? "that of <mimic> (" : "that of another place (") +
                textOf(*joint.mimic) + ") differs");
        } else if (!joint.mimic && leadsBack(joint, stated.leader)) {
            notes_.push_back(name + ": its mimic in " + own + " is not used: joint " +
                             excerpt(printable(stated.leader)) + " follows this one");
        } else if (!joint.mimic) {
            joint.mimic = made;
            added_.insert(joint.name);
            notes_.push_back(name + ": has no <mimic>; it " + textOf(*made) + ", as " + stated.place +
                             " states");
        }
    }

    static std::optional<double> numberOr(const std::string& text, double usual) {
        return text.empty() ? usual : finiteNumber(text);
    }

    // Whether the leader follows the joint, or is the joint.
    bool leadsBack(const urdf::Joint& joint, const std::string& leader) const {
        std::set<std::string> seen;
        for (auto at = model_.joints_.find(leader); at != model_.joints_.end();) {
            if (at->first == joint.name || !at->second->mimic || !seen.insert(at->first).second) {
                return at->first == joint.name;
            }
            at = model_.joints_.find(at->second->mimic->joint_name);
        }
        return false;
    }

    urdf::ModelInterface& model_;
    std::vector<std::string>& notes_;
    std::set<std::string> added_; // joints without a <mimic> of their own
};

bool isNarrower(const urdf::Joint& joint, const std::string& key, const std::string& text) {
    const std::optional<double> value = finiteNumber(text);
    if (!value || !joint.limits || joint.type == urdf::Joint::CONTINUOUS) {
        return false;
    }
    const double lower = joint.limits->lower, upper = joint.limits->upper,
                 least = kNarrower * (upper - lower);
    return (key == "min" && *value > lower + least) || (key == "max" && *value < upper - least);
}

} // namespace

void addControlMimics(urdf::ModelInterface& model, const std::string& text, std::vector<std::string>& notes) {
    MimicAdder adder(model, notes);
    for (const StatedMimic& stated : statedMimics(text)) {
        adder.add(stated);
    }
}

void noteCommandLimits(const urdf::ModelInterface& model, const std::string& text,
                       std::vector<std::string>& notes) {
    const std::string joints = "robot/ros2_control/joint";
    std::string name, interface;
    std::set<std::string> noted;
    for (XmlTags tags(text); tags.next();) {
        const std::string_view tag = tags.tag().text;
        if (tags.path() == "robot/ros2_control" && tags.tag().name == "joint") {
            name = xmlAttribute(tag, "name");
        } else if (tags.path() == joints) {
            interface = tags.tag().name == "command_interface" ? xmlAttribute(tag, "name") : "";
        } else if (tags.path() == joints + "/command_interface" && interface == "position") {
            const auto joint = model.joints_.find(name);
            if (joint != model.joints_.end() &&
                isNarrower(*joint->second, xmlAttribute(tag, "name"), tags.content()) &&
                noted.insert(name).second) {
                notes.push_back(
                    "joint " + printable(name) +
                    ": the narrower limits of <command_interface> are not read; arm.joints sets limits");
            }
        }
    }
}

} // namespace fathom
