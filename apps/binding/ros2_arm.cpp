// SPDX-License-Identifier: Apache-2.0
#include "apps/binding/ros2_arm.h"

#include "devices/ros2/joint_readings.h"
#include "devices/ros2/ros2_graph.h"
#include "engine/types/clock.h"

#include <algorithm>

namespace fathom {

namespace {

constexpr double kOldPosture = 0.25; // [s]

// Joints of the chain that follow no other.
std::vector<RobotJoint> ownJoints(const ArmModel& model) {
    std::vector<RobotJoint> joints;
    for (const ArmJoint& joint : model.joints) {
        if (!joint.mimic) {
            joints.push_back({joint.name, joint.lower, joint.upper});
        }
    }
    return joints;
}

// Joints that robots publish, and whose positions are not needed.
std::set<std::string> otherJoints(const ArmModel& model) {
    std::set<std::string> names;
    for (const ArmJoint& joint : model.joints) {
        if (joint.mimic) {
            names.insert(joint.name);
        }
    }
    for (const ArmFinger& finger : model.fingers) {
        names.insert(finger.name);
    }
    return names;
}

// Commands are ignored.
class MeasuredDevice final : public ArmDevice {
public:
    MeasuredDevice(Ros2Inbox& inbox, const ArmModel& model, const std::string& topic)
        : inbox_(inbox)
        , model_(model)
        , readings_("arm", topic, ownJoints(model), otherJoints(model)) {
        feedback_.homed = true;
    }
    void step(double now, const ArmCommand& command) noexcept override;
    const ArmFeedback& feedback() const noexcept override { return feedback_; }
    void reset() noexcept override {}
    const JointReadings& readings() const { return readings_; }

private:
    Ros2Inbox& inbox_;
    const ArmModel& model_;
    JointReadings readings_;
    ArmFeedback feedback_;
};

void MeasuredDevice::step(double, const ArmCommand& command) noexcept {
    try {
        for (const Ros2Message& taken : inbox_.take(0)) {
            readings_.take(taken);
        }
    } catch (const std::exception&) { // out of memory: the posture ages
    }
    JointVector q{};
    size_t own = 0;
    for (size_t k = 0; k < model_.count(); ++k) {
        q[k] = model_.joints[k].mimic ? 0.0 : readings_.positions()[own++];
    }
    model_.follow(q);
    std::copy_n(q.begin(), model_.count(), feedback_.position.begin());
    feedback_.age = readings_.age(monotonicSeconds());
    feedback_.stale = !(feedback_.age <= kOldPosture);
    feedback_.holding = command.hold;
    feedback_.damaged = readings_.skipped();
}

class Ros2Arm final : public ArmLine {
public:
    Ros2Arm(const Ros2ArmRequest& request, const ArmModel& model)
        : request_(request)
        , model_(model)
        , graph_(Ros2Graph::join(request.place))
        , inbox_(graph_)
        , device_(inbox_, model_, request.joints) {
        inbox_.subscribe(request.joints, "sensor_msgs/msg/JointState", Ros2Qos::Sensor);
    }
    ArmDevice& device() noexcept override { return device_; }
    bool gone() const noexcept override { return false; }
    // Nothing here moves the arm, so nothing has to stop it.
    void awaitWatchdog(const std::atomic<bool>&) override {}
    bool watched(double) noexcept override { return true; }
    double patience() const override { return request_.wait; }
    std::string silence() const override;

private:
    Ros2ArmRequest request_;
    ArmModel model_;
    std::shared_ptr<Ros2Graph> graph_;
    Ros2Inbox inbox_;
    MeasuredDevice device_;
};

std::string Ros2Arm::silence() const {
    return device_.readings().whyIncomplete() + " in domain " + std::to_string(request_.place.domain) +
           " on network " + request_.place.network + "; topics seen: " + graph_->publications();
}

} // namespace

std::unique_ptr<ArmLine> openRos2Arm(const Ros2ArmRequest& request, const ArmModel& model) {
    return std::make_unique<Ros2Arm>(request, model);
}

} // namespace fathom
