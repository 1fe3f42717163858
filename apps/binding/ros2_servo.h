// SPDX-License-Identifier: Apache-2.0
// Commands for servo controllers of ROS 2, which make a robot follow the tool: the tool's velocity
// (geometry_msgs/msg/TwistStamped, the input of MoveIt Servo), and the joints of its arm
// (trajectory_msgs/msg/ JointTrajectory of one point).
#pragma once

#include "apps/binding/ros2_tick.h"
#include "devices/ros2/joint_readings.h"
#include "devices/ros2/ros2_graph.h"
#include "devices/ros2/ros2_output_request.h"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace fathom {

// One thread. The robot stands still whenever a real arm would (StepRecord::armHold): the velocity is zero,
// and no joints are sent. Joints are sent only while the robot's measured ones are new and close to them.
class Ros2Servo {
public:
    // Throws BadInput, Error.
    Ros2Servo(std::shared_ptr<Ros2Graph> graph, const Ros2OutputRequest& request,
              std::vector<Ros2Joint> joints);
    ~Ros2Servo(); // the last velocity is zero

    void tick(const Ros2Tick& tick);
    // The run sends no ticks any more, or none for now: the velocity becomes zero.
    void rest();
    // Why no joints are sent; empty while they are, and without a topic for them.
    const std::string& held() const { return held_; }
    bool sendsJoints() const { return trajectory_ != nullptr; }

    static constexpr double kFarJoint = 0.35; // [rad] between a joint and the robot's
    static constexpr double kFarSlide = 0.05; // [m]
    static constexpr double kOld = 0.5;       // [s] age of measured joints

private:
    void sendTwist(const Ros2Tick& tick);
    void sendJoints(const Ros2Tick& tick);
    void receive();
    std::string whyHeld(const Ros2Tick& tick) const;

    std::string frame_;
    double period_;                                  // [s] between messages
    std::vector<Ros2Joint> joints_;                  // of the arm
    std::vector<size_t> own_;                        // places of those that a controller drives: no <mimic>
    std::vector<std::string> names_;                 // of these
    std::vector<double> positions_;                  // of these, as sent
    std::unique_ptr<Ros2Writer> twist_, trajectory_; // null = not asked for
    std::unique_ptr<Ros2Inbox> measuredInbox_;
    JointReadings measured_; // of own_
    std::optional<Ros2Tick> before_;
    std::string held_;
};

} // namespace fathom
