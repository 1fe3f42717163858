// SPDX-License-Identifier: Apache-2.0
// Poses of StreamChooser between depth and colour that are not registered.
#include "devices/bag/stream_choice.h"

#include "devices/recorded/lens_model.h"
#include "devices/recorded/recording_extrinsics.h"
#include "engine/scene/camera_limits.h"
#include "engine/types/error.h"
#include "engine/types/printed.h"

#include <algorithm>
#include <cmath>

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
    constexpr double kMaxApart = 0.005, kMaxTurned = 0.01; // [m], [rad]
    return glm::distance(a.position, b.position) <= kMaxApart && turnBetween(a, b) <= kMaxTurned;
}

} // namespace

StreamChooser::Relation StreamChooser::relateByPose(const ImageStream& depth, const ImageStream& colour) {
    FoundPose found = sdkPose(depth, colour);
    // The Orbbec SDK records the pose to its colour camera, not to the cameras of a stereo pair.
    const std::string sensor = orbbecSensor(colour.name);
    if (!found.pose && !isRealSenseTopic(depth.name) && (sensor.empty() || sensor == "2")) {
        found = driverPose(depth, colour);
    }
    if (found.pose) {
        const bool registered = isIdentity(*found.pose) && sameLens(*depth.lens, *colour.lens);
        return {2, registered, registered ? Pose{} : *found.pose, "", found.warning, found.source};
    }
    const std::string topic = isRealSenseTopic(depth.name)
                                  ? parentTopic(baseTopic(colour.name), 2) + "/tf/0"
                                  : "tf_static between the frames, .../extrinsics/depth_to_color";
    return {0,
            false,
            {},
            "extrinsics: " + (found.warning.empty() ? "missing" : found.warning) +
                " (allowed: depth registered to colour (same frame and lens), or the topic " + topic +
                ", or extrinsics=FILE or colour=none after the file name)"};
}

// A pose that lenses of one rig do not have: beyond the bounds of any camera colour is unrelated to depth.
void StreamChooser::doubtRig(Relation& relation, bool warns) {
    const std::optional<RigFault> fault = rigFault(relation.colourTdepth);
    if (!fault) {
        return;
    }
    std::string words = relation.source + ": " + fault->value + " (allowed: " + fault->allowed;
    if (!(glm::length(relation.colourTdepth.position) <= kFarthestColour)) {
        words += "; or extrinsics=FILE or colour=none after the file name)";
        relation = {0, false, {}, "extrinsics: " + words};
        return;
    }
    if (!warns) {
        return;
    }
    words += "): regions by colour are lost if this is wrong; extrinsics=FILE or colour=none after the file "
             "name";
    relation.warning += (relation.warning.empty() ? "" : "; ") + words;
}

// By the driver's topic or by tf, and why it may be wrong. Some versions of realsense-ros publish the inverse
// of the topic; tf tells.
StreamChooser::FoundPose StreamChooser::driverPose(const ImageStream& depth, const ImageStream& colour) {
    const MessageTopic* source = poseTopic(depth, colour);
    if (sharesFrame(depth, colour) && !depth.frame.empty()) { // the topic is that of depth in its own frame
        return source == nullptr ? FoundPose{}
                                 : FoundPose{Pose{}, "depth and colour are both in frame '" + depth.frame +
                                                         "': " + source->name + " is not used"};
    }
    std::string fault;
    const auto topic = topicPose(source, fault);
    const std::string tf = "tf between '" + depth.frame + "' and '" + colour.frame + "'";
    const auto frames = depth.frame != colour.frame ? frames_.pose(depth.frame, colour.frame) : std::nullopt;
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
        std::string all;
        for (const std::string& one : {fault.empty() ? "" : fault + ": tf is used", axes,
                                       frames_.twicePublished(depth.frame, colour.frame)}) {
            all += (all.empty() || one.empty() ? "" : "; ") + one;
        }
        return {frames, all, tf};
    }
    if (nearlySame(*topic, *frames) || !axes.empty()) {
        return {topic, "", source->name};
    }
    if (nearlySame(inverse(*topic), *frames)) {
        return {frames, "", tf};
    }
    const std::string apart =
        printed("%.1f mm and %.2f degrees", 1e3 * glm::distance(topic->position, frames->position),
                glm::degrees(turnBetween(*topic, *frames)));
    return {topic,
            "the driver's topic depth_to_color, which is used, and " + tf + " differ by " + apart +
                "; extrinsics=FILE after the file name decides",
            source->name};
}

// Maps points of the common reference to the stream, as in a recording folder (recording_intrinsics.cpp).
StreamChooser::FoundPose StreamChooser::sdkPose(const ImageStream& depth, const ImageStream& colour) {
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
const MessageTopic* StreamChooser::poseTopic(const ImageStream& depth, const ImageStream& colour) const {
    const MessageTopic* best = nullptr;
    for (const MessageTopic& topic : file_.topics()) {
        if (topic.type.ends_with("/Extrinsics") && namedExtrinsicsOf(topic.name, depth.name, colour.name) &&
            !topic.messages.empty() && (best == nullptr || topic.name.size() > best->name.size())) {
            best = &topic;
        }
    }
    return best;
}

std::optional<Pose> StreamChooser::topicPose(const MessageTopic* topic, std::string& fault) {
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
