// SPDX-License-Identifier: Apache-2.0
#include "apps/binding/ros2_topics.h"

#include "apps/binding/ros2_markers.h"

#include <algorithm>
#include <iterator>

namespace fathom {

namespace {

constexpr const char* kPoseType = "geometry_msgs/msg/PoseStamped";
constexpr const char* kWrenchType = "geometry_msgs/msg/WrenchStamped";
constexpr const char* kDeviceFrame = "fathom_device";

} // namespace

Ros2Topics::Ros2Topics(const Ros2OutputRequest& request, const std::vector<Ros2Joint>& joints)
    : graph_(Ros2Graph::join(request.place))
    , frame_(request.frame)
    , wrenches_{{graph_, request.prefix + "/wrench", kWrenchType, Ros2Qos::Reliable},
                {graph_, request.prefix + "/device_wrench", kWrenchType, Ros2Qos::Reliable}}
    , poses_{{graph_, request.prefix + "/tool_pose", kPoseType, Ros2Qos::Reliable},
             {graph_, request.prefix + "/device_pose", kPoseType, Ros2Qos::Reliable},
             {graph_, request.prefix + "/target_pose", kPoseType, Ros2Qos::Reliable}}
    , regions_{{graph_, request.prefix + "/regions", "sensor_msgs/msg/PointCloud2", Ros2Qos::Reliable},
               {graph_, request.prefix + "/markers", "visualization_msgs/msg/MarkerArray", Ros2Qos::Reliable}}
    , diagnostics_(graph_, "/diagnostics", "diagnostic_msgs/msg/DiagnosticArray", Ros2Qos::Reliable) {
    if (request.commands) {
        commands_ = std::make_unique<Ros2Commands>(graph_, request.prefix);
    }
    if (request.frames) {
        frames_ = std::make_unique<Ros2Writer>(graph_, "/tf", "tf2_msgs/msg/TFMessage", Ros2Qos::Reliable);
    }
    if (!request.twist.empty() || !request.trajectory.empty()) {
        servo_ = std::make_unique<Ros2Servo>(graph_, request, joints);
    }
    std::transform(joints.begin(), joints.end(), std::back_inserter(joints_),
                   [](const Ros2Joint& joint) { return joint.name; });
    if (!joints_.empty()) {
        jointState_ = std::make_unique<Ros2Writer>(graph_, request.prefix + "/joint_states",
                                                   "sensor_msgs/msg/JointState", Ros2Qos::Reliable);
    }
}

void Ros2Topics::send(Ros2Writer& writer, const ros2::Message& message) noexcept {
    unsent_ += writer.write(message) ? 0 : 1;
}

void Ros2Topics::tick(const Ros2Tick& tick) {
    const StepRecord& r = tick.record;
    const ros2::Header header{tick.time, frame_};
    if (wrenches_.hand.watched()) {
        send(wrenches_.hand, ros2::wrench(header, r.wrench.force, r.wrench.torque));
    }
    if (wrenches_.device.watched()) {
        send(wrenches_.device,
             ros2::wrench({tick.time, kDeviceFrame}, r.deviceWrench.force, r.deviceWrench.torque));
    }
    if (poses_.tool.watched()) {
        send(poses_.tool, ros2::pose(header, r.tool));
    }
    if (poses_.device.watched()) {
        send(poses_.device, ros2::pose(header, r.device));
    }
    if (r.guidanceClass >= 0 && poses_.target.watched()) {
        send(poses_.target, ros2::pose(header, r.guidanceTarget));
    }
    if (jointState_ && jointState_->watched()) {
        send(*jointState_,
             ros2::jointState(header, joints_, std::span(r.arm.posture.q).first(joints_.size())));
    }
    if (frames_ && frames_->watched()) {
        sendFrames(tick);
    }
    if (servo_) {
        servo_->tick(tick);
    }
    if (tick.time - diagnosed_ >= kDiagnosisPeriod) {
        diagnose(tick);
    }
}

void Ros2Topics::rest() {
    if (servo_) {
        servo_->rest();
    }
}

void Ros2Topics::diagnose(const Ros2Tick& tick) {
    diagnosed_ = tick.time;
    std::vector<ros2::Diagnosis> parts = diagnosis_.of(tick, unsent_);
    if (servo_ && servo_->sendsJoints()) {
        const bool held = !servo_->held().empty();
        parts.push_back({held ? ros2::Diagnosis::Level::Warning : ros2::Diagnosis::Level::Ok,
                         "fathom: robot",
                         held ? servo_->held() : "gets joints",
                         {}});
    }
    if (diagnostics_.watched()) {
        send(diagnostics_, ros2::diagnostics({tick.time, ""}, parts));
    }
}

void Ros2Topics::sendFrames(const Ros2Tick& tick) {
    const auto sendFrame = [&](const char* child, const Pose& baseTchild) {
        send(*frames_, ros2::transform({tick.time, frame_}, {frame_, child, baseTchild}));
    };
    sendFrame("fathom_tool", tick.record.tool);
    if (tick.baseTcamera) {
        sendFrame("fathom_camera", *tick.baseTcamera);
    }
}

void Ros2Topics::regions(const Ros2Regions& regions) {
    const ros2::Header header{regions.time, frame_};
    if (regions_.cloud.watched()) {
        send(regions_.cloud, ros2::regions(header, regions.points));
    }
    if (regions_.markers.watched()) {
        send(regions_.markers, ros2::markers(header, ros2Markers(regions)));
    }
}

} // namespace fathom
