// SPDX-License-Identifier: Apache-2.0
// Finds the streams of ros2_camera.h and their lenses.
#include "devices/bag/stream_chooser.h"
#include "devices/images/byte_order.h"
#include "devices/images/metre_units.h"
#include "devices/ros2/ros2_camera.h"
#include "engine/types/clock.h"
#include "engine/types/error.h"
#include "engine/types/log.h"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace fathom {

namespace {

constexpr const char* kRos2Image = "sensor_msgs/msg/Image";
constexpr const char* kRos2Compressed = "sensor_msgs/msg/CompressedImage";
constexpr const char* kRos2Transforms = "tf2_msgs/msg/TFMessage";

bool isCompressedTopic(const std::string& topic) {
    return topic.ends_with("/compressed") || topic.ends_with("/compressedDepth");
}

// Where camera drivers publish the lens of an image topic.
std::vector<std::string> infoTopics(const std::string& image) {
    const std::string base = baseTopic(image);
    return {parentTopic(base, 1) + "/camera_info", base + "/camera_info", base + "_info"};
}

} // namespace

Ros2Camera::Ros2Camera(const Ros2Request& request)
    : request_(request)
    , graph_(Ros2Graph::join(request.place))
    , inbox_(graph_)
    , messages_("ros2") {
    depth_ = subscribeImages(request_.options.depth);
    if (request_.options.colour != "none") {
        colour_ = subscribeImages(request_.options.colour);
    }
    subscribeOthers();
    awaitStreams();
    chooseUnit();
    pairs_.emplace(choice_.colour.has_value());
    depthStamps_.emplace(choice_.depth.name);
    if (choice_.colour) {
        colourStamps_.emplace(choice_.colour->name);
    }
    slots_.emplace(info().slotPixels(), info().hasColour, kFramesInFlight + 1);
    lastDepth_ = monotonicSeconds();
}

Ros2Camera::Topic Ros2Camera::subscribeImages(const std::string& topic) {
    Topic out;
    out.compressed = isCompressedTopic(topic);
    out.publisher.emplace(description(), topic);
    const char* type = out.compressed ? kRos2Compressed : kRos2Image;
    out.place = inbox_.subscribe(topic, type, Ros2Qos::Sensor);
    messages_.add(topic, type, 1);
    return out;
}

void Ros2Camera::subscribeOthers() {
    constexpr size_t kMaxTransforms = 200;
    const SourceOptions& options = request_.options;
    std::set<std::string> infos;
    for (const std::string& image : {options.depth, options.colour}) {
        for (const std::string& topic : image == "none" ? std::vector<std::string>{} : infoTopics(image)) {
            infos.insert(topic);
        }
    }
    infos = options.info.empty() ? infos : std::set<std::string>{options.info};
    const auto add = [&](const std::string& topic, const std::string& type, Ros2Qos qos, size_t most) {
        messages_.add(topic, type, most);
        return inbox_.subscribe(topic, type, qos);
    };
    for (const std::string& topic : infos) {
        add(topic, "sensor_msgs/msg/CameraInfo", Ros2Qos::Sensor, 1);
    }
    tfStatic_ = add("/tf_static", kRos2Transforms, Ros2Qos::Latched, kMaxTransforms);
    if (!request_.frame.empty()) {
        tf_ = add("/tf", kRos2Transforms, Ros2Qos::Stream, kMaxTransforms);
        moving_.emplace(description(), request_.frame);
    }
    add(parentTopic(options.depth, 2) + "/extrinsics/depth_to_color", "realsense2_camera_msgs/msg/Extrinsics",
        Ros2Qos::Latched, 1);
}

// Keeps the newest messages of all topics. Returns whether there are any.
bool Ros2Camera::gather() {
    bool any = false;
    for (size_t topic = 0; topic < messages_.topics().size(); ++topic) {
        for (Ros2Message& taken : inbox_.take(topic)) {
            if (moving_ && (topic == tf_ || topic == tfStatic_)) {
                moving_->transforms().take(taken, topic == tfStatic_);
            }
            messages_.keep(topic, std::move(taken.message));
            any = true;
        }
    }
    return any;
}

void Ros2Camera::logWarnings() const {
    for (const std::string& warning : choice_.warnings) {
        log::warn("{}: {}", request_.text, warning);
    }
}

// The choice is repeated with each new message until it succeeds: lenses and transforms may come late.
void Ros2Camera::awaitStreams() {
    const auto end = Clock::now() + std::chrono::duration<double>(request_.wait);
    std::string why = "no message";
    for (;;) {
        if (gather()) {
            try {
                choice_ = StreamChooser(messages_, request_.options).choose();
                choice_.camera.poseless = !moving_;
                why = moving_ ? moving_->follow(choice_.depth.frame) : "";
                if (why.empty()) {
                    logWarnings();
                    toAxis_ = choice_.rangeImages ? RangeToAxis(info().depth) : RangeToAxis();
                    return;
                }
            } catch (const Error& e) {
                why = e.what();
            }
        }
        const double left = std::chrono::duration<double>(end - Clock::now()).count();
        if (left <= 0.0) {
            throw BadInput(missing(why));
        }
        inbox_.wait(std::min(left, 0.1));
    }
}

std::string Ros2Camera::missing(const std::string& why) const {
    return request_.text + ": after " + std::to_string(std::lround(request_.wait)) + " s in domain " +
           std::to_string(request_.place.domain) + " on network " + request_.place.network + ": " + why +
           "; topics seen: " + graph_->publications();
}

// Metres get the finest unit that holds the scene's far; without one, one and a half times the farthest depth
// of the first image that is no background. That image also decides the order of bytes.
void Ros2Camera::chooseUnit() {
    constexpr double kMillimetre = 0.001; // REP 118: 16-bit depth is in millimetres
    const MessageCursor message = messages_.read(messages_.topics()[choice_.depth.topic], 0);
    ros::Image first = choice_.depth.compressed ? ros::compressedImage(message) : ros::image(message);
    if (ros::depthOrder(first) == ByteOrder::Swapped) {
        skip(choice_.depth.name + ": " + wrongOrder(first.bigEndian), 0);
        first.bigEndian = !first.bigEndian;
        bigEndian_ = first.bigEndian;
    }
    CameraInfo& camera = choice_.camera;
    if (!ros::holdsMetres(first)) {
        request_.options.checkUnit(request_.text);
        camera.metresPerUnit = request_.options.scale.value_or(kMillimetre);
        return;
    }
    const double metresPerValue = request_.options.scale.value_or(1.0), farthest = request_.options.farthest;
    camera.metresPerUnit = std::isfinite(farthest)
                               ? unitForMetres(farthest)
                               : unitForMetres(ros::valueSpan(first).scaled(metresPerValue), farthest);
    valuesPerUnit_ = camera.metresPerUnit / metresPerValue;
}

} // namespace fathom
