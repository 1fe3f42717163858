// SPDX-License-Identifier: Apache-2.0
#include "devices/bag/bag_motion.h"

#include "devices/bag/ros_messages.h"
#include "devices/recorded/name_words.h"
#include "engine/types/error.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <optional>
#include <string_view>
#include <vector>

namespace fathom {

namespace {

// Over 5 mm or 0.57 degrees: more than noise.
bool isMoved(const Pose& a, const Pose& b) {
    constexpr double kMinTravel = 0.005, kMinTurn = 0.01; // [m], [rad]
    const double cosine = std::min(1.0, std::abs(glm::dot(a.rotation, b.rotation)));
    return glm::distance(a.position, b.position) > kMinTravel || 2.0 * std::acos(cosine) > kMinTurn;
}

// Some places over the whole topic, with several messages in a row at each: programs take turns on one topic.
std::vector<size_t> someOf(size_t count) {
    constexpr size_t kPlaces = 12, kInRow = 12;
    std::vector<size_t> some;
    if (count <= kPlaces * kInRow) {
        for (size_t i = 0; i < count; ++i) {
            some.push_back(i);
        }
        return some;
    }
    for (size_t place = 0; place < kPlaces; ++place) {
        for (size_t i = 0; i < kInRow; ++i) {
            some.push_back(place * (count - kInRow) / (kPlaces - 1) + i);
        }
    }
    return some;
}

struct MotionLink {
    std::string parent, topic;
    Pose first;
    bool moves = false;
};
using MotionLinks = std::map<std::string, MotionLink>; // by child

void addLinks(MessageFile& file, const MessageTopic& topic, MotionLinks& links) {
    for (const size_t i : someOf(topic.messages.size())) {
        try {
            for (const ros::FrameLink& link : ros::frameLinks(file.read(topic, i))) {
                if (!link.isValid) {
                    continue;
                }
                const auto [place, isNew] =
                    links.try_emplace(link.child, MotionLink{link.parent, topic.name, link.parentTchild});
                MotionLink& known = place->second;
                known.moves = known.moves || (known.parent == link.parent && known.topic == topic.name &&
                                              isMoved(known.first, link.parentTchild));
            }
        } catch (const Error&) { // a damaged message says nothing
        }
    }
}

std::string movingLink(MessageFile& file, std::string frame) {
    constexpr int kMaxLinks = 64; // a loop ends there
    MotionLinks links;
    for (const MessageTopic& topic : file.topics()) {
        if (topic.type == "tf2_msgs/TFMessage" || topic.type == "tf/tfMessage") {
            addLinks(file, topic, links);
        }
    }
    for (int i = 0; i < kMaxLinks; ++i) {
        const auto link = links.find(frame);
        if (link == links.end()) {
            return "";
        }
        if (link->second.moves) {
            return link->second.topic + " moves '" + frame + "' in '" + link->second.parent + "'";
        }
        frame = link->second.parent;
    }
    return "";
}

struct PoseType {
    std::string_view type;
    bool named; // its header is followed by the name of the frame that moves
};
constexpr std::array kPoseTypes{
    PoseType{"nav_msgs/Odometry", true}, PoseType{"geometry_msgs/TransformStamped", true},
    PoseType{"geometry_msgs/PoseStamped", false}, PoseType{"geometry_msgs/PoseWithCovarianceStamped", false}};

bool hasMotion(MessageFile& file, const MessageTopic& topic, bool named) {
    std::optional<Pose> first;
    for (const size_t i : someOf(topic.messages.size())) {
        try {
            MessageCursor message = file.read(topic, i);
            ros::skipHeader(message);
            if (named) {
                message.name();
            }
            const Pose pose = ros::transform(message);
            if (first && isMoved(*first, pose)) {
                return true;
            }
            first = first ? first : std::optional(pose);
        } catch (const Error&) { // a damaged message says nothing
        }
    }
    return false;
}

std::string movingTopic(MessageFile& file) {
    for (const PoseType& kind : kPoseTypes) {
        for (const MessageTopic& topic : file.topics()) {
            if (topic.type == kind.type && !nameOtherThing(nameWords(topic.name)) &&
                hasMotion(file, topic, kind.named)) {
                return topic.name;
            }
        }
    }
    return "";
}

} // namespace

std::string cameraMotion(MessageFile& file, const std::string& frame) {
    const std::string known = "the camera counts as fixed", how = "; a folder with poses.txt plays them";
    if (const std::string link = frame.empty() ? "" : movingLink(file, frame); !link.empty()) {
        return known + ", but " + link + ": poses of a bag are not read" + how;
    }
    const std::string topic = movingTopic(file);
    return topic.empty() ? ""
                         : known + ": if the poses of " + topic + " are its own, they are not read" + how;
}

} // namespace fathom
