// SPDX-License-Identifier: Apache-2.0
#include "devices/bag/stream_poses.h"

#include "engine/types/error.h"
#include "engine/types/printed.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>

namespace fathom {

namespace {

double turnBetween(const Pose& a, const Pose& b) {
    return 2.0 * std::acos(std::min(1.0, std::abs(glm::dot(a.rotation, b.rotation))));
}

// As far as a calibration and the drawing of the same camera differ.
bool nearlySame(const Pose& a, const Pose& b) {
    constexpr double kMaxApart = 0.005, kMaxTurned = 0.01; // [m], [rad]
    return glm::distance(a.position, b.position) <= kMaxApart && turnBetween(a, b) <= kMaxTurned;
}

std::string poseDifference(const Pose& a, const Pose& b) {
    return printed("%.1f mm and %.2f degrees", 1e3 * glm::distance(a.position, b.position),
                   glm::degrees(turnBetween(a, b)));
}

// Those that are not empty.
std::string allWarnings(std::initializer_list<std::string> warnings) {
    std::string all;
    for (const std::string& one : warnings) {
        all += (all.empty() || one.empty() ? "" : "; ") + one;
    }
    return all;
}

} // namespace

bool sharesFrame(const ImageStream& depth, const ImageStream& colour) {
    const bool sdk = isSdkTopic(depth.name) || isSdkTopic(colour.name); // its frames are all "0"
    return !sdk && depth.frame == colour.frame &&
           (!depth.frame.empty() || namedOneCamera(depth.name, colour.name));
}

FoundPose StreamPoses::between(const ImageStream& depth, const ImageStream& colour) {
    FoundPose found = sdkPose(depth, colour);
    // The Orbbec SDK records the pose to its colour camera, not to the cameras of a stereo pair.
    const std::string sensor = orbbecSensor(colour.name);
    if (!found.pose && !isRealSenseTopic(depth.name) && (sensor.empty() || sensor == "2")) {
        found = driverPose(depth, colour);
    }
    return found;
}

std::optional<Pose> StreamPoses::byFrames(const ImageStream& depth, const ImageStream& colour) {
    return frames_.pose(depth.frame, colour.frame);
}

// By the driver's topic or by tf, and why it may be wrong. Some versions of realsense-ros publish the inverse
// of the topic; tf tells.
FoundPose StreamPoses::driverPose(const ImageStream& depth, const ImageStream& colour) {
    const MessageTopic* source = poseTopic(depth, colour);
    if (sharesFrame(depth, colour) && !depth.frame.empty()) { // the topic is that of depth in its own frame
        return source == nullptr ? FoundPose{}
                                 : FoundPose{Pose{}, "depth and colour are both in frame '" + depth.frame +
                                                         "': " + source->name + " is not used"};
    }
    std::string fault;
    const auto topic = topicPose(source, fault);
    const std::string tf = "tf between '" + depth.frame + "' and '" + colour.frame + "'";
    const auto frames = depth.frame != colour.frame ? byFrames(depth, colour) : std::nullopt;
    const std::string axes = frames ? frames_.axesWarning(depth.frame, colour.frame) : "";
    if (!frames) {
        const std::string moving = topic ? "" : frames_.whyMoving(depth.frame, colour.frame);
        return {topic,
                topic                              ? ""
                : !fault.empty() || moving.empty() ? fault
                                                   : "missing; " + moving,
                topic ? source->name : ""};
    }
    if (!topic) {
        return {frames,
                allWarnings({fault.empty() ? "" : fault + ": tf is used", axes,
                             frames_.twicePublished(depth.frame, colour.frame)}),
                tf};
    }
    if (nearlySame(*topic, *frames) || !axes.empty()) {
        return {topic, "", source->name};
    }
    if (nearlySame(inverse(*topic), *frames)) {
        return {frames, "", tf};
    }
    return {topic,
            "the driver's topic depth_to_color, which is used, and " + tf + " differ by " +
                poseDifference(*topic, *frames) + "; extrinsics=FILE after the file name decides",
            source->name};
}

// Maps points of the common reference to the stream, as in a recording folder (recording_intrinsics.cpp).
FoundPose StreamPoses::sdkPose(const ImageStream& depth, const ImageStream& colour) {
    if (!isRealSenseTopic(depth.name) || !isRealSenseTopic(colour.name)) {
        return {};
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
            return {ros::transform(file_.read(*other, 0)) * inverse(depthTf), "", other->name};
        }
    }
    return {};
}

// The topic .../extrinsics/depth_to_color of the drivers of RealSense and Orbbec, of the camera of both;
// null: there is none.
const MessageTopic* StreamPoses::poseTopic(const ImageStream& depth, const ImageStream& colour) const {
    const MessageTopic* best = nullptr;
    for (const MessageTopic& topic : file_.topics()) {
        if (topic.type.ends_with("/Extrinsics") && namedExtrinsicsOf(topic.name, depth.name, colour.name) &&
            !topic.messages.empty() && (best == nullptr || topic.name.size() > best->name.size())) {
            best = &topic;
        }
    }
    return best;
}

std::optional<Pose> StreamPoses::topicPose(const MessageTopic* topic, std::string& fault) {
    if (topic == nullptr) {
        return std::nullopt;
    }
    const bool orbbec = topic->type.starts_with("orbbec") || topic->type.starts_with("astra");
    const auto driver = orbbec ? ros::ExtrinsicsOf::Orbbec : ros::ExtrinsicsOf::RealSense;
    try {
        return ros::extrinsics(file_.read(*topic, 0), driver);
    } catch (const Error& e) {
        fault = topic->name + ": " + e.what();
        return std::nullopt;
    }
}

} // namespace fathom
