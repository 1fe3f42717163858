// SPDX-License-Identifier: Apache-2.0
#include "devices/bag/bag_camera.h"

#include "devices/bag/ros_messages.h"
#include "engine/types/error.h"
#include "engine/types/log.h"

#include <algorithm>
#include <cmath>

namespace fathom {

namespace {

constexpr const char* kImage = "sensor_msgs/Image";

// "/a/b/image/data" -> "/a/b", else "/a/b/image_raw" -> "/a/b".
std::string parentOf(const std::string& topic, int levels) {
    std::string parent = topic;
    for (int i = 0; i < levels; ++i) {
        parent.erase(std::min(parent.find_last_of('/'), parent.size()));
    }
    return parent;
}

bool isRealSense(const std::string& topic) {
    return topic.ends_with("/image/data");
}

double medianStep(const std::vector<double>& stamps) {
    std::vector<double> steps;
    for (size_t i = 1; i < stamps.size(); ++i) {
        steps.push_back(stamps[i] - stamps[i - 1]);
    }
    if (steps.empty()) {
        return 0.0;
    }
    std::nth_element(steps.begin(), steps.begin() + static_cast<long>(steps.size() / 2), steps.end());
    return steps[steps.size() / 2];
}

} // namespace

BagCamera::BagCamera(const std::filesystem::path& file)
    : bag_(file) {
    try {
        chooseTopics();
        readLenses();
    } catch (const BadInput&) {
        throw;
    } catch (const Error& e) {
        throw BadInput(file.string(), "content", e.what(), "whole messages");
    }
    tolerance_ = tolerance();
    slots_.emplace(std::max(info_.depth.pixels(), info_.colour.pixels()), info_.hasColour,
                   kFramesInFlight + 1);
}

std::optional<BagCamera::Stream> BagCamera::openStream(const BagTopic& topic,
                                                       bool (*wanted)(const std::string&)) {
    if (topic.type != kImage || topic.messages.empty()) {
        return std::nullopt;
    }
    const ros::Image first = ros::image(bag_.read(topic.messages.front()));
    if (!wanted(first.encoding)) {
        return std::nullopt;
    }
    Stream stream{&topic, first.frame, first.encoding, {}};
    for (const BagEntry& entry : topic.messages) {
        stream.stamps.push_back(1e-9 * static_cast<double>(entry.time));
    }
    return stream;
}

void BagCamera::chooseTopics() {
    std::string seen;
    for (const BagTopic& topic : bag_.topics()) {
        if (depth_.topic == nullptr) {
            depth_ = openStream(topic, ros::isDepth).value_or(Stream{});
        }
        if (!colour_) {
            colour_ = openStream(topic, ros::isColour);
        }
        seen += topic.type == kImage ? (seen.empty() ? "" : ", ") + topic.name : "";
    }
    if (depth_.topic == nullptr) {
        throw BadInput(bag_.file().string(), "topics", seen.empty() ? "no images" : seen,
                       "one of sensor_msgs/Image with encoding 16UC1, mono16 or 32FC1");
    }
}

Intrinsics BagCamera::lensOf(const Stream& stream) {
    const std::string& name = stream.topic->name;
    const std::string info =
        isRealSense(name) ? parentOf(name, 2) + "/info/camera_info" : parentOf(name, 1) + "/camera_info";
    const BagTopic* topic = bag_.find(info);
    if (topic == nullptr || topic->messages.empty()) {
        throw BadInput(bag_.file().string(), info, "missing", "sensor_msgs/CameraInfo beside " + name);
    }
    const Intrinsics lens = ros::cameraInfo(bag_.read(topic->messages.front()));
    if (lens.width < 1 || lens.height < 1 || lens.width > 3840 || lens.height > 2160) {
        throw BadInput(bag_.file().string(), info,
                       std::to_string(lens.width) + "x" + std::to_string(lens.height),
                       "at most 3840x2160 pixels");
    }
    return lens;
}

// Maps points of the common reference to the stream, as in a recording folder (recording_intrinsics.cpp).
Pose BagCamera::tfOf(const Stream& stream) {
    const std::string name = parentOf(stream.topic->name, 2) + "/tf/0";
    const BagTopic* topic = isRealSense(stream.topic->name) ? bag_.find(name) : nullptr;
    if (topic == nullptr || topic->messages.empty()) {
        throw BadInput(bag_.file().string(), "extrinsics", "missing",
                       "depth registered to colour (same frame and lens), or the topic " + name);
    }
    return ros::transform(bag_.read(topic->messages.front()));
}

double BagCamera::depthUnit() {
    constexpr double kMillimetre = 0.001; // REP 118
    if (!isRealSense(depth_.topic->name)) {
        return kMillimetre;
    }
    const BagTopic* topic = bag_.find(parentOf(depth_.topic->name, 3) + "/option/Depth Units/value");
    if (topic == nullptr || topic->messages.empty()) {
        return kMillimetre;
    }
    // Stored as float: use 0.001, not 0.0010000000474974513.
    const double unit =
        std::round(1e9 * static_cast<double>(ros::float32(bag_.read(topic->messages.front())))) * 1e-9;
    return unit > 0.0 ? unit : kMillimetre;
}

void BagCamera::readLenses() {
    info_.depth = lensOf(depth_);
    info_.metresPerUnit = depthUnit();
    info_.hasColour = colour_.has_value();
    info_.colour = info_.depth;
    if (!colour_) {
        return;
    }
    const Intrinsics colour = lensOf(*colour_);
    const Intrinsics& depth = info_.depth;
    const bool sameLens = colour.width == depth.width && colour.height == depth.height &&
                          colour.fx == depth.fx && colour.fy == depth.fy && colour.cx == depth.cx &&
                          colour.cy == depth.cy;
    const std::string& name = depth_.topic->name;
    if (sameLens && (depth_.frame == colour_->frame || name.find("aligned") != std::string::npos ||
                     name.find("registered") != std::string::npos)) {
        return;
    }
    info_.registered = false;
    info_.colour = colour;
    info_.colourTdepth = tfOf(*colour_) * inverse(tfOf(depth_));
}

double BagCamera::tolerance() const {
    const double slower = std::max(medianStep(depth_.stamps), colour_ ? medianStep(colour_->stamps) : 0.0);
    return slower > 0.0 ? 0.5 * slower : 0.05;
}

std::optional<size_t> BagCamera::colourFor(double stamp) const {
    const std::vector<double>& stamps = colour_->stamps;
    const auto distance = [stamp](double s) { return std::abs(s - stamp); };
    const auto best = std::min_element(stamps.begin(), stamps.end(),
                                       [&](double a, double b) { return distance(a) < distance(b); });
    return best != stamps.end() && distance(*best) <= tolerance_
               ? std::optional(static_cast<size_t>(best - stamps.begin()))
               : std::nullopt;
}

// Returns the fault; empty when the slot is filled.
std::string BagCamera::read(size_t index, FrameSlot& slot, double& stamp) {
    const auto sized = [](const ros::Image& image, const Intrinsics& lens) {
        return image.width == lens.width && image.height == lens.height;
    };
    const ros::Image depth = ros::image(bag_.read(depth_.topic->messages[index]));
    stamp = depth.stamp;
    if (!sized(depth, info_.depth) || depth.encoding != depth_.encoding) {
        return "size or encoding differs from the first frame";
    }
    std::string fault = ros::depthRows(depth, slot.depth());
    if (!fault.empty() || !colour_) {
        return fault;
    }
    const auto pair = colourFor(depth_.stamps[index]);
    if (!pair) {
        return "no colour frame within " + std::to_string(tolerance_) + " s";
    }
    const ros::Image colour = ros::image(bag_.read(colour_->topic->messages[*pair]));
    return sized(colour, info_.colour) ? ros::colourRows(colour, slot.colour())
                                       : "colour size differs from its camera_info";
}

std::optional<Frame> BagCamera::next() {
    FrameSlot* slot = slots_->acquire();
    if (slot == nullptr) {
        throw Error(description() + ": all frame buffers are leased");
    }
    while (cursor_ < depth_.topic->messages.size()) {
        const uint32_t index = cursor_++;
        std::string fault;
        double stamp = 0.0;
        try {
            fault = read(index, *slot, stamp);
        } catch (const Error& e) {
            fault = e.what();
        }
        if (fault.empty()) {
            delivered_ = true;
            Frame::Content content;
            content.index = index;
            content.sourceNumber = index;
            content.captureTime = stamp;
            content.depth = slot->depth().first(info_.depth.pixels());
            content.colour = slot->colour().first(colour_ ? info_.colour.pixels() : 0);
            return slot->lend(content);
        }
        ++skipped_;
        firstFault_ = firstFault_.empty() ? fault : firstFault_;
        log::warn("{}: frame {} skipped: {}", bag_.file().string(), index, fault);
    }
    slot->release();
    if (!delivered_) {
        throw BadInput(bag_.file().string(), "frames", "none is usable; first: " + firstFault_,
                       "one usable frame");
    }
    return std::nullopt;
}

} // namespace fathom
