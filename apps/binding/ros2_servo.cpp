// SPDX-License-Identifier: Apache-2.0
#include "apps/binding/ros2_servo.h"

#include "engine/types/clock.h"
#include "engine/types/error.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace fathom {

namespace {

constexpr double kLongestGap = 0.1; // [s] between two steps of one velocity
constexpr double kReachedIn = 2.0;  // periods from a message to its joints

std::vector<size_t> drivenJoints(const std::vector<Ros2Joint>& joints) {
    std::vector<size_t> driven;
    for (size_t i = 0; i < joints.size(); ++i) {
        if (!joints[i].follows) {
            driven.push_back(i);
        }
    }
    return driven;
}

std::vector<RobotJoint> readJoints(const std::vector<std::string>& names) {
    std::vector<RobotJoint> read;
    std::transform(names.begin(), names.end(), std::back_inserter(read),
                   [](const std::string& name) { return RobotJoint{name}; });
    return read;
}

std::vector<std::string> namesAt(const std::vector<Ros2Joint>& joints, const std::vector<size_t>& places) {
    std::vector<std::string> names;
    std::transform(places.begin(), places.end(), std::back_inserter(names),
                   [&](size_t place) { return joints[place].name; });
    return names;
}

} // namespace

Ros2Servo::Ros2Servo(std::shared_ptr<Ros2Graph> graph, const Ros2OutputRequest& request,
                     std::vector<Ros2Joint> joints)
    : frame_(request.frame)
    , period_(1.0 / request.rate)
    , joints_(std::move(joints))
    , own_(drivenJoints(joints_))
    , names_(namesAt(joints_, own_))
    , positions_(own_.size())
    , measured_("ros2", request.measured, readJoints(names_)) {
    if (!request.twist.empty()) {
        twist_ = std::make_unique<Ros2Writer>(graph, request.twist, "geometry_msgs/msg/TwistStamped",
                                              Ros2Qos::Reliable);
    }
    if (request.trajectory.empty()) {
        return;
    }
    if (joints_.empty()) {
        throw BadInput("--ros2", "trajectory", request.trajectory, "only with a scene that has an arm");
    }
    trajectory_ = std::make_unique<Ros2Writer>(graph, request.trajectory,
                                               "trajectory_msgs/msg/JointTrajectory", Ros2Qos::Reliable);
    measuredInbox_ = std::make_unique<Ros2Inbox>(graph);
    measuredInbox_->subscribe(request.measured, "sensor_msgs/msg/JointState", Ros2Qos::Sensor);
}

Ros2Servo::~Ros2Servo() {
    rest();
}

void Ros2Servo::rest() {
    if (twist_) {
        twist_->write(ros2::twist({utcNanoseconds(), frame_}, dvec3(0.0), dvec3(0.0)));
    }
    before_.reset();
}

void Ros2Servo::tick(const Ros2Tick& tick) {
    if (twist_) {
        sendTwist(tick);
    }
    if (trajectory_) {
        sendJoints(tick);
    }
    before_ = tick;
}

// The mean velocity since the message before: a controller that integrates it does not drift.
void Ros2Servo::sendTwist(const Ros2Tick& tick) {
    dvec3 linear(0.0), angular(0.0);
    const StepRecord& now = tick.record;
    const double time = before_ ? now.t - before_->record.t : 0.0;
    if (time > 0.0 && time < kLongestGap && !now.armHold && !before_->record.armHold) {
        const Pose& from = before_->record.tool;
        linear = (now.tool.position - from.position) / time;
        angular = rotationBetween(from.rotation, now.tool.rotation) / time;
    }
    twist_->write(ros2::twist({tick.time, frame_}, linear, angular));
}

void Ros2Servo::receive() {
    for (const Ros2Message& taken : measuredInbox_->take(0)) {
        measured_.take(taken);
    }
}

std::string Ros2Servo::whyHeld(const Ros2Tick& tick) const {
    if (tick.record.armHold) {
        return "held: forces are off, the newest frame is too old, or the tool is trapped";
    }
    if (measured_.age(monotonicSeconds()) > kOld) {
        return "held: no measured joints";
    }
    for (size_t i = 0; i < own_.size(); ++i) {
        const Ros2Joint& joint = joints_[own_[i]];
        const double apart = std::abs(measured_.positions()[i] - tick.record.arm.posture.q[own_[i]]);
        if (!(apart <= (joint.slides ? kFarSlide : kFarJoint))) {
            return "held: joint " + joint.name + " of the robot is elsewhere";
        }
    }
    return "";
}

void Ros2Servo::sendJoints(const Ros2Tick& tick) {
    receive();
    held_ = whyHeld(tick);
    if (held_.empty()) { // a stamp of 0: from now on
        std::transform(own_.begin(), own_.end(), positions_.begin(),
                       [&](size_t place) { return tick.record.arm.posture.q[place]; });
        trajectory_->write(ros2::trajectory({0, frame_}, names_, positions_, kReachedIn * period_));
    }
}

} // namespace fathom
