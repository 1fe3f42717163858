// SPDX-License-Identifier: Apache-2.0
#include "devices/bag/image_stream.h"

#include "devices/recorded/recording_intrinsics.h"
#include "engine/types/error.h"

#include <cmath>

namespace fathom {

namespace {

constexpr const char* kImageType = "sensor_msgs/Image";
constexpr const char* kCompressedType = "sensor_msgs/CompressedImage";

std::string streamSize(uint32_t width, uint32_t height) {
    return std::to_string(width) + "x" + std::to_string(height);
}

// The camera_info of the camera, or the one that is asked for; null = none, for the reason in stream.noLens.
const MessageTopic* infoOf(const MessageFile& file, const std::string& asked, ImageStream& stream) {
    const auto names = asked.empty() ? lensTopics(stream.name) : std::vector<std::string>{asked};
    std::string why = names.front() + ": missing";
    for (const std::string& name : names) {
        if (const MessageTopic* topic = file.find(name); topic != nullptr && !topic->messages.empty()) {
            return topic;
        }
        const std::string fault = file.faultOf(name);
        why = fault.empty() ? why : name + ": " + fault;
    }
    stream.noLens = why + " (allowed: sensor_msgs/CameraInfo beside " + stream.name +
                    ", or info=TOPIC or intrinsics=FILE behind the file's name)";
    return nullptr;
}

void readLens(MessageFile& file, const std::string& asked, ImageStream& stream) {
    const MessageTopic* topic = infoOf(file, asked, stream);
    if (topic == nullptr) {
        return;
    }
    const ros::CameraInfo info = ros::cameraInfo(file.read(*topic, 0));
    const Intrinsics lens = info.lens(namedRectified(stream.name));
    const std::string told = topic->name + ": ";
    if (lens.width < 1 || lens.height < 1 || lens.width > kMaxImageWidth || lens.height > kMaxImageHeight) {
        stream.noLens = told + streamSize(lens.width, lens.height) + " (allowed: at most 3840x2160 pixels)";
    } else if (stream.width != lens.width || stream.height != lens.height) {
        stream.noLens = told + streamSize(lens.width, lens.height) + " where the images of " + stream.name +
                        " have " + streamSize(stream.width, stream.height) +
                        " (allowed: the images' size, binning and region of interest applied)";
    } else if (!lens.invertible()) {
        stream.noLens = told + "distortion (allowed: coefficients that can be inverted over the whole image)";
    } else {
        stream.lens = lens;
        stream.info = static_cast<size_t>(topic - file.topics().data());
        stream.raw = info.raw;
        stream.rectified = namedRectified(stream.name);
        stream.turned = info.turned;
    }
}

} // namespace

bool sameLens(const Intrinsics& a, const Intrinsics& b) {
    const auto equal = [](double one, double other) { return std::abs(one - other) < 1e-6; };
    return a.width == b.width && a.height == b.height && equal(a.fx, b.fx) && equal(a.fy, b.fy) &&
           equal(a.cx, b.cx) && equal(a.cy, b.cy) && a.distortion == b.distortion && a.divisor == b.divisor &&
           a.model == b.model;
}

bool mayBeDepth(const ImageStream& stream) {
    const bool named = stream.role == NamedRole::Depth || stream.encoding != "mono16";
    return stream.content == ros::Content::Depth && stream.role != NamedRole::Infrared && named;
}

std::vector<ImageStream> imageStreams(MessageFile& file, const std::string& info) {
    std::vector<ImageStream> streams;
    for (size_t i = 0; i < file.topics().size(); ++i) {
        const MessageTopic& topic = file.topics()[i];
        const bool compressed = topic.type == kCompressedType;
        if ((topic.type != kImageType && !compressed) || topic.messages.empty()) {
            continue;
        }
        ImageStream stream;
        stream.topic = i;
        stream.name = topic.name;
        stream.compressed = compressed;
        stream.role = namedRole(topic.name);
        try {
            const MessageCursor message = file.read(topic, 0);
            const ros::Image first = compressed ? ros::compressedImage(message) : ros::image(message);
            stream.frame = first.frame;
            stream.encoding = compressed ? first.format : first.encoding;
            stream.content = ros::content(first);
            stream.format = ros::colourFormat(first);
            const auto size = ros::sizeOf(first);
            stream.width = size ? size->first : 0;
            stream.height = size ? size->second : 0;
            readLens(file, info, stream);
        } catch (const Error& e) {
            stream.noLens = stream.name + ": " + e.what();
        }
        streams.push_back(std::move(stream));
    }
    return streams;
}

} // namespace fathom
