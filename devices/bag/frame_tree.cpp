// SPDX-License-Identifier: Apache-2.0
#include "devices/bag/frame_tree.h"

#include "engine/types/error.h"
#include "engine/types/log.h"
#include "engine/types/lower_case.h"
#include "engine/types/printed.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace fathom {

namespace {

// Within this distance [m] and turn [rad].
bool samePose(const Pose& a, const Pose& b, double apart, double turned) {
    const double cosine = std::min(1.0, std::abs(glm::dot(a.rotation, b.rotation)));
    return glm::distance(a.position, b.position) <= apart && 2.0 * std::acos(cosine) <= turned;
}

std::string millimetres(const dvec3& position) {
    return printed("(%.1f, %.1f, %.1f) mm", 1e3 * position.x, 1e3 * position.y, 1e3 * position.z);
}

bool unturned(const dquat& rotation) {
    return std::abs(rotation.w) > 1.0 - 1e-9;
}

bool namedOptical(const std::string& frame) {
    return lowerCase(frame).find("optical") != std::string::npos;
}

} // namespace

void FrameTree::readOnce() {
    if (!read_) {
        read_ = true;
        read();
    }
}

void FrameTree::read() {
    constexpr size_t kMaxMessages = 2000;
    for (const MessageTopic& topic : file_.topics()) {
        if (topic.type != "tf2_msgs/TFMessage" && topic.type != "tf/tfMessage") {
            continue;
        }
        for (size_t i = 0; i < std::min(kMaxMessages, topic.messages.size()); ++i) {
            try {
                for (const ros::FrameLink& link : ros::frameLinks(file_.read(topic, i))) {
                    add(topic, link);
                }
            } catch (const Error& e) {
                logSkipped(topic, std::string("a message is skipped: ") + e.what());
            }
        }
    }
}

void FrameTree::add(const MessageTopic& topic, const ros::FrameLink& link) {
    if (!link.isValid) {
        logSkipped(topic, "a transform of frame '" + link.child +
                              "' is skipped (allowed: finite numbers, a quaternion that is not 0)");
        return;
    }
    // A drawing of a camera and its calibration differ more than a link of /tf jitters that does not move.
    const bool isStatic = topic.name.ends_with("static");
    const double apart = isStatic ? 0.005 : 0.001, turned = isStatic ? 0.01 : 0.002; // [m], [rad]
    const auto [place, isNew] = links_.try_emplace(link.child, Link{link.parent, link.parentTchild});
    Link& before = place->second;
    if (isNew || before.moves ||
        (before.parent == link.parent && samePose(before.parentTchild, link.parentTchild, 1e-6, 9e-5))) {
        return;
    }
    before.moves =
        before.parent != link.parent || !samePose(before.parentTchild, link.parentTchild, apart, turned);
    before.isTwice = before.isTwice || isStatic;
    before.otherParent = link.parent;
    before.otherTchild = link.parentTchild;
}

void FrameTree::logSkipped(const MessageTopic& topic, const std::string& what) {
    constexpr size_t kMaxWarned = 32;
    if (warned_.size() < kMaxWarned && warned_.insert(topic.name + what).second) {
        log::warn("{}: {}: {} (logged once)", file_.file().string(), topic.name, what);
    }
}

std::map<std::string, Pose> FrameTree::ancestors(const std::string& frame) const {
    std::map<std::string, Pose> poses{{frame, Pose{}}};
    Pose pose;
    for (auto link = links_.find(frame); link != links_.end() && !link->second.moves;
         link = links_.find(link->second.parent)) {
        pose = link->second.parentTchild * pose;
        if (!poses.emplace(link->second.parent, pose).second) {
            break; // a loop
        }
    }
    return poses;
}

std::optional<Pose> FrameTree::pose(const std::string& from, const std::string& to) {
    readOnce();
    const auto ofFrom = ancestors(from), ofTo = ancestors(to);
    for (const auto& [frame, pose] : ofFrom) {
        if (const auto common = ofTo.find(frame); common != ofTo.end()) {
            return inverse(common->second) * pose;
        }
    }
    return std::nullopt;
}

std::vector<std::string> FrameTree::frameAndAncestors(const std::string& frame) const {
    std::vector<std::string> frames{frame};
    for (auto link = links_.find(frame);
         link != links_.end() && std::ranges::find(frames, link->second.parent) == frames.end();
         link = links_.find(link->second.parent)) {
        frames.push_back(link->second.parent);
    }
    return frames;
}

// Children of the links, whether these move or not; empty where nothing connects the frames.
std::vector<std::string> FrameTree::linksBetween(const std::string& from, const std::string& to) {
    readOnce();
    std::vector<std::string> ofFrom = frameAndAncestors(from), ofTo = frameAndAncestors(to);
    const auto common = std::ranges::find_first_of(ofFrom, ofTo);
    if (common == ofFrom.end()) {
        return {};
    }
    ofTo.erase(std::ranges::find(ofTo, *common), ofTo.end());
    ofFrom.erase(common, ofFrom.end());
    ofFrom.insert(ofFrom.end(), ofTo.begin(), ofTo.end());
    return ofFrom;
}

std::string FrameTree::whyMoving(const std::string& from, const std::string& to) {
    for (const std::string& child : linksBetween(from, to)) {
        const Link& link = links_.at(child);
        if (!link.moves) {
            continue;
        }
        const std::string first = "tf has '" + child + "' in '" + link.parent + "'";
        if (link.otherParent != link.parent) {
            return first + " and in '" + link.otherParent + "'";
        }
        const bool moved = glm::distance(link.parentTchild.position, link.otherTchild.position) >= 1e-4;
        return first + (moved ? " at " + millimetres(link.parentTchild.position) + " and at " +
                                    millimetres(link.otherTchild.position)
                              : " in two directions");
    }
    return "";
}

std::string FrameTree::twicePublished(const std::string& from, const std::string& to) {
    for (const std::string& child : linksBetween(from, to)) {
        const Link& link = links_.at(child);
        if (link.isTwice && !link.moves) {
            const std::string apart = printed(
                "%.1f mm", 1e3 * glm::distance(link.parentTchild.position, link.otherTchild.position));
            return "two transforms of '" + child + "' in tf_static differ by " + apart +
                   ": the first one is used";
        }
    }
    return "";
}

bool FrameTree::hasOpticalChild(const std::string& frame) const {
    return std::ranges::any_of(links_, [&](const auto& named) {
        const auto& [child, link] = named;
        return link.parent == frame && namedOptical(child) && !unturned(link.parentTchild.rotation);
    });
}

std::string FrameTree::axesWarning(const std::string& from, const std::string& to) {
    const std::optional<Pose> between = pose(from, to);
    if (!between || namedOptical(from) || namedOptical(to) || glm::length(between->position) < 1e-3) {
        return "";
    }
    const bool body = hasOpticalChild(from) || hasOpticalChild(to);
    return !body && !unturned(between->rotation)
               ? ""
               : "tf between the frames '" + from + "' and '" + to +
                     "' is taken in axes of images (x right, y down, " + "z forward)" +
                     (body ? ", but tf has optical frames below them" : "") +
                     "; if x is forward, regions by colour are shifted: extrinsics=FILE after the file "
                     "name";
}

} // namespace fathom
