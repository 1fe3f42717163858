// SPDX-License-Identifier: Apache-2.0
#include "devices/ros2/live_transforms.h"

#include "engine/types/log.h"

#include <algorithm>

namespace fathom {

namespace {

std::string quotedFrame(const std::string& name) {
    return "'" + name + "'";
}

} // namespace

void LiveTransforms::take(const Ros2Message& message, bool isStatic) {
    constexpr size_t kMaxFaults = 32;
    const auto skip = [&](const char* what, const Error& why) {
        ++skipped_;
        if (faults_.size() < kMaxFaults && faults_.insert(why.what()).second) {
            log::warn("{}: {}: {} skipped: {} (logged once)", reader_, isStatic ? "/tf_static" : "/tf", what,
                      why.what());
        }
    };
    try {
        for (const ros::FrameLink& link : ros::frameLinks(MessageCursor(message.message->bytes(), true))) {
            try {
                add(link, message, isStatic);
            } catch (const Error& e) {
                skip("transform", e);
            }
        }
    } catch (const Error& e) {
        skip("message", e);
    }
}

void LiveTransforms::add(const ros::FrameLink& link, const Ros2Message& message, bool isStatic) {
    const std::string &parent = link.parent, &child = link.child;
    if (std::max(parent.size(), child.size()) > kLongestName || parent.empty() || child.empty()) {
        throw Error("a frame's name has no or over " + std::to_string(kLongestName) + " bytes");
    }
    if (!link.isValid) {
        throw Error("the pose of frame " + quotedFrame(child) + " is not finite, or its quaternion is 0");
    }
    if (parent == child) {
        throw Error("frame " + quotedFrame(child) + " is its own parent");
    }
    if (!links_.contains(child) && links_.size() >= kMaxFrames) {
        throw Error("over " + std::to_string(kMaxFrames) + " frames");
    }
    Link& to = links_.try_emplace(child, Link{parent}).first->second;
    if (!isStatic) {
        if (!to.publisher) {
            to.publisher.emplace(reader_, "/tf of " + quotedFrame(child));
        }
        if (!to.publisher->accepts(message)) {
            return;
        }
    }
    if (to.parent != parent || to.fixed != isStatic || isStatic) {
        to.poses.clear();
    }
    to.parent = parent;
    to.fixed = isStatic;
    insert(to, {link.stamp, link.parentTchild});
}

void LiveTransforms::insert(Link& to, const Stamped& pose) {
    if (!to.poses.empty() && pose.time < to.poses.back().time - kHistory) {
        if (++to.back < kMaxBackward) {
            return;
        }
        to.poses.clear();
    }
    to.back = 0;
    const auto place = std::ranges::lower_bound(to.poses, pose.time, {}, &Stamped::time);
    if (place != to.poses.end() && place->time == pose.time) {
        *place = pose;
    } else {
        to.poses.insert(place, pose);
    }
    while (to.poses.size() > kMaxKept || to.poses.front().time < to.poses.back().time - kHistory) {
        to.poses.pop_front();
    }
}

void LiveTransforms::forgetMoving() {
    std::erase_if(links_, [](const auto& link) { return !link.second.fixed; });
}

// The frame itself first.
std::vector<std::string> LiveTransforms::ancestors(const std::string& frame) const {
    std::vector<std::string> names{frame};
    for (auto link = links_.find(frame); link != links_.end() && names.size() <= kMaxFrames;
         link = links_.find(link->second.parent)) { // a loop ends, too
        names.push_back(link->second.parent);
    }
    return names;
}

std::optional<std::string> LiveTransforms::common(const std::string& a, const std::string& b) const {
    const std::vector<std::string> ofA = ancestors(a), ofB = ancestors(b);
    const std::set<std::string> known(ofB.begin(), ofB.end());
    const auto found = std::ranges::find_if(ofA, [&](const std::string& f) { return known.contains(f); });
    return found != ofA.end() ? std::optional(*found) : std::nullopt;
}

LiveTransforms::Answer LiveTransforms::at(const std::string& child, const Link& link, double stamp) {
    constexpr double kSlack = 1e-6; // [s] rounding of stamps since 1970
    const std::string name = "/tf of " + quotedFrame(child);
    if (link.fixed) {
        return {link.poses.front().parentTchild};
    }
    const auto next = std::ranges::lower_bound(link.poses, stamp - kSlack, {}, &Stamped::time);
    if (next == link.poses.end()) {
        return {std::nullopt, true, name + " ends before it"};
    }
    if (next->time <= stamp + kSlack) {
        return {next->parentTchild};
    }
    if (next == link.poses.begin()) {
        return {std::nullopt, false, name + " begins after it"};
    }
    const Stamped& before = *(next - 1);
    if (next->time - before.time > kLongestGap) {
        return {std::nullopt, false, name + " has a gap there"};
    }
    return {interpolate(before.parentTchild, next->parentTchild,
                        (stamp - before.time) / (next->time - before.time))};
}

// ancestor_T_from
LiveTransforms::Answer LiveTransforms::along(const std::string& from, const std::string& ancestor,
                                             double stamp) const {
    Pose pose;
    for (std::string frame = from; frame != ancestor;) {
        const Link& link = links_.at(frame);
        const Answer step = at(frame, link, stamp);
        if (!step.pose) {
            return step;
        }
        pose = *step.pose * pose;
        frame = link.parent;
    }
    return {pose};
}

std::string LiveTransforms::whyApart(const std::string& from, const std::string& to) const {
    return common(from, to) ? "" : "no transforms between " + quotedFrame(from) + " and " + quotedFrame(to);
}

LiveTransforms::Answer LiveTransforms::pose(const std::string& from, const std::string& to,
                                            double stamp) const {
    const std::optional<std::string> meet = common(from, to);
    if (!meet) {
        return {std::nullopt, true, whyApart(from, to)};
    }
    const Answer down = along(from, *meet, stamp), up = down.pose ? along(to, *meet, stamp) : down;
    return up.pose ? Answer{inverse(*up.pose) * *down.pose} : up;
}

} // namespace fathom
