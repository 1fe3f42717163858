// SPDX-License-Identifier: Apache-2.0
#include "devices/bag/frame_tree.h"

#include "engine/types/error.h"
#include "engine/types/log.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <glm/geometric.hpp>

namespace fathom {

namespace {

bool samePose(const Pose& a, const Pose& b) {
    return glm::length(a.position - b.position) < 1e-6 &&
           std::abs(glm::dot(a.rotation, b.rotation)) > 1.0 - 1e-9;
}

bool unturned(const dquat& rotation) {
    return std::abs(rotation.w) > 1.0 - 1e-9;
}

bool namedOptical(std::string frame) {
    std::ranges::transform(frame, frame.begin(),
                           [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return frame.find("optical") != std::string::npos;
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
                tellSkipped(topic, std::string("a message is skipped: ") + e.what());
            }
        }
    }
}

void FrameTree::add(const MessageTopic& topic, const ros::FrameLink& link) {
    if (!link.isValid) {
        tellSkipped(topic, "a transform of frame '" + link.child +
                               "' is skipped (allowed: finite numbers, a quaternion that is not 0)");
        return;
    }
    Link& before = links_.try_emplace(link.child, Link{link.parent, link.parentTchild}).first->second;
    before.moves =
        before.moves || before.parent != link.parent || !samePose(before.parentTchild, link.parentTchild);
}

void FrameTree::tellSkipped(const MessageTopic& topic, const std::string& what) {
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
                     "; if x is forward, regions by colour are shifted: extrinsics=FILE behind the file's "
                     "name";
}

} // namespace fathom
