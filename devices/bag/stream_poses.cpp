// SPDX-License-Identifier: Apache-2.0
// Poses of StreamChooser between depth and colour that are not registered.
#include "devices/bag/stream_choice.h"

#include "devices/recorded/lens_model.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <tuple>

namespace fathom {

namespace {

bool isIdentity(const Pose& pose) {
    return glm::length(pose.position) < 1e-9 && std::abs(std::abs(pose.rotation.w) - 1.0) < 1e-12;
}

double turnBetween(const Pose& a, const Pose& b) {
    return 2.0 * std::acos(std::min(1.0, std::abs(glm::dot(a.rotation, b.rotation))));
}

// As far as a calibration and the drawing of the same camera differ.
bool nearlySame(const Pose& a, const Pose& b) {
    constexpr double kMostApart = 0.005, kMostTurned = 0.01; // [m], [rad]
    return glm::distance(a.position, b.position) <= kMostApart && turnBetween(a, b) <= kMostTurned;
}

} // namespace

StreamChooser::Relation StreamChooser::relateByPose(const ImageStream& depth, const ImageStream& colour) {
    std::optional<Pose> pose = sdkPose(depth, colour);
    std::string warning;
    // The Orbbec SDK records the pose to its colour camera, not to the cameras of a stereo pair.
    const std::string sensor = orbbecSensor(colour.name);
    if (!pose && !isRealSenseTopic(depth.name) && (sensor.empty() || sensor == "2")) {
        std::tie(pose, warning) = driverPose(depth, colour);
    }
    if (pose) {
        const bool registered = isIdentity(*pose) && sameLens(*depth.lens, *colour.lens);
        return {2, registered, registered ? Pose{} : *pose, "", warning};
    }
    const std::string topic = isRealSenseTopic(depth.name)
                                  ? parentTopic(baseTopic(colour.name), 2) + "/tf/0"
                                  : "tf_static between the frames, .../extrinsics/depth_to_color";
    return {0,
            false,
            {},
            "extrinsics: missing (allowed: depth registered to colour (same frame and lens), or the topic " +
                topic + ", or extrinsics=FILE or colour=none behind the file's name)"};
}

// By the driver's topic or by tf, and why it may be wrong. Some versions of realsense-ros publish the inverse
// of the topic; tf tells.
std::pair<std::optional<Pose>, std::string> StreamChooser::driverPose(const ImageStream& depth,
                                                                      const ImageStream& colour) {
    const auto topic = topicPose(depth, colour);
    const auto frames = depth.frame != colour.frame ? frames_.pose(depth.frame, colour.frame) : std::nullopt;
    const std::string axes = frames ? frames_.axesWarning(depth.frame, colour.frame) : "";
    if (!topic || !frames) {
        return {topic ? topic : frames, topic ? "" : axes};
    }
    if (nearlySame(*topic, *frames) || !axes.empty()) {
        return {topic, ""};
    }
    if (nearlySame(inverse(*topic), *frames)) {
        return {frames, ""};
    }
    char apart[160];
    std::snprintf(apart, sizeof apart, "%.1f mm and %.2f degrees",
                  1e3 * glm::distance(topic->position, frames->position),
                  glm::degrees(turnBetween(*topic, *frames)));
    return {topic, "the driver's topic depth_to_color, which is used, and tf between '" + depth.frame +
                       "' and '" + colour.frame + "' differ by " + apart +
                       "; extrinsics=FILE behind the file's name decides"};
}

// Maps points of the common reference to the stream, as in a recording folder (recording_intrinsics.cpp).
std::optional<Pose> StreamChooser::sdkPose(const ImageStream& depth, const ImageStream& colour) {
    if (!isRealSenseTopic(depth.name) || !isRealSenseTopic(colour.name)) {
        return std::nullopt;
    }
    const std::string ofDepth = parentTopic(baseTopic(depth.name), 2) + "/tf/",
                      ofColour = parentTopic(baseTopic(colour.name), 2) + "/tf/";
    for (const MessageTopic& topic : file_.topics()) {
        if (!topic.name.starts_with(ofDepth) || topic.messages.empty()) {
            continue;
        }
        const MessageTopic* other = file_.find(ofColour + topic.name.substr(ofDepth.size()));
        if (other != nullptr && !other->messages.empty()) {
            const Pose depthTf = ros::transform(file_.read(topic, 0));
            return ros::transform(file_.read(*other, 0)) * inverse(depthTf);
        }
    }
    return std::nullopt;
}

// The topic .../extrinsics/depth_to_color of the drivers of RealSense and Orbbec, of the camera of both.
std::optional<Pose> StreamChooser::topicPose(const ImageStream& depth, const ImageStream& colour) {
    const MessageTopic* best = nullptr;
    for (const MessageTopic& topic : file_.topics()) {
        if (topic.type.ends_with("/Extrinsics") && namedExtrinsicsOf(topic.name, depth.name, colour.name) &&
            !topic.messages.empty() && (best == nullptr || topic.name.size() > best->name.size())) {
            best = &topic;
        }
    }
    if (best == nullptr) {
        return std::nullopt;
    }
    const bool orbbec = best->type.starts_with("orbbec") || best->type.starts_with("astra");
    const auto driver = orbbec ? ros::ExtrinsicsOf::Orbbec : ros::ExtrinsicsOf::RealSense;
    return ros::extrinsics(file_.read(*best, 0), driver);
}

} // namespace fathom
