// SPDX-License-Identifier: Apache-2.0
#include "devices/ros2/joint_readings.h"

#include "devices/bag/ros_messages.h"
#include "devices/ros2/received_messages.h"
#include "engine/types/log.h"

#include <algorithm>
#include <cmath>

namespace fathom {

JointReadings::JointReadings(std::string reader, std::string topic, std::vector<RobotJoint> joints,
                             std::set<std::string> others)
    : reader_(std::move(reader))
    , topic_(std::move(topic))
    , joints_(std::move(joints))
    , others_(std::move(others))
    , publisher_(reader_, topic_)
    , stamps_(topic_)
    , positions_(joints_.size(), std::nan(""))
    , times_(joints_.size(), std::nan("")) {}

void JointReadings::once(const std::string& what) {
    constexpr size_t kMaxNamed = 64;
    if (named_.size() < kMaxNamed && named_.insert(what).second) {
        log::warn("{}: {}: {} (logged once)", reader_, topic_, what);
    }
}

void JointReadings::skip(const std::string& fault) {
    ++skipped_;
    lastFault_ = fault;
    once("message skipped: " + fault);
}

void JointReadings::nameUnknown(const std::string& joint) {
    if (!others_.contains(joint)) {
        once("joint " + joint + " is not of the arm and is ignored");
    }
}

void JointReadings::nameMissing(double now) {
    first_ = first_ == 0.0 ? now : first_;
    for (size_t i = 0; i < joints_.size(); ++i) {
        if (now - (std::isnan(times_[i]) ? first_ : times_[i]) > kMissing) {
            once("joint " + joints_[i].name + " is missing");
        }
    }
}

// A message without a stamp is as old as its arrival. NaN: not newer than the one before.
double JointReadings::captureTime(const Ros2Message& message) {
    const double stamp = ros::stamp(MessageCursor(message.message->bytes(), true));
    if (stamp == 0.0) {
        return message.message->arrival;
    }
    if (stamp == lastStamp_ || !stamps_.forward(stamp)) {
        return std::nan("");
    }
    lastStamp_ = stamp;
    return stamps_.captureTime(stamp, *message.message);
}

void JointReadings::read(const Ros2Message& message) {
    const auto named = ros2::jointPositions(message.message->bytes());
    std::vector<std::pair<size_t, double>> found;
    for (const auto& [name, position] : named) {
        const auto joint =
            std::ranges::find_if(joints_, [&, &n = name](const RobotJoint& j) { return j.name == n; });
        if (joint == joints_.end()) {
            nameUnknown(name);
            continue;
        }
        const double inside = std::clamp(position, joint->lower, joint->upper);
        if (!(std::abs(position - inside) <= kOutside)) {
            throw Error("joint " + name + ": " + std::to_string(position) + " (allowed: " +
                        std::to_string(joint->lower) + " to " + std::to_string(joint->upper) + ")");
        }
        if (std::ranges::any_of(found, [&](const auto& f) { return &joints_[f.first] == &*joint; })) {
            throw Error("joint " + name + " twice");
        }
        found.emplace_back(static_cast<size_t>(joint - joints_.begin()), inside);
    }
    if (found.empty() || !publisher_.accepts(message)) {
        return;
    }
    const double time = captureTime(message);
    if (!(time > newest_)) { // also a late message, which LiveStamps dates like the one before
        throw Error("a stamp is not later than the one before");
    }
    newest_ = time;
    for (const auto& [joint, position] : found) {
        positions_[joint] = position;
        times_[joint] = time;
    }
    nameMissing(message.message->arrival);
}

void JointReadings::take(const Ros2Message& message) {
    try {
        read(message);
    } catch (const Error& e) {
        skip(e.what());
    }
}

double JointReadings::age(double now) const {
    double oldest = 0.0;
    for (const double time : times_) {
        oldest = std::max(oldest, std::isnan(time) ? std::numeric_limits<double>::infinity() : now - time);
    }
    return oldest;
}

std::string JointReadings::whyIncomplete() const {
    std::string names;
    for (size_t i = 0; i < joints_.size(); ++i) {
        names += std::isnan(times_[i]) ? (names.empty() ? "" : ", ") + joints_[i].name : "";
    }
    const std::string why = lastFault_.empty() ? "" : "; last message skipped: " + lastFault_;
    return (names.empty() ? "no new message" : "no message with joint " + names) + why;
}

} // namespace fathom
