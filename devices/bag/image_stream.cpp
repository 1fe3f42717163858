// SPDX-License-Identifier: Apache-2.0
#include "devices/bag/image_stream.h"

#include "devices/recorded/lens_model.h"
#include "devices/recorded/recording_intrinsics.h"
#include "engine/types/error.h"
#include "engine/types/number_text.h"

#include <algorithm>
#include <cmath>
#include <strings.h>

namespace fathom {

namespace {

constexpr const char* kImageType = "sensor_msgs/Image";
constexpr const char* kInfoType = "sensor_msgs/CameraInfo";
constexpr const char* kCompressedType = "sensor_msgs/CompressedImage";

// The camera_info of the camera, or the requested one: that is depth's, and of others only without
// one of their own. Null = none, for the reason in stream.noLens.
const MessageTopic* infoOf(const MessageFile& file, const std::string& requested, ImageStream& stream) {
    auto names = lensTopics(stream.name);
    if (!requested.empty()) {
        names.resize(stream.content == ros::Content::Depth ? 0 : names.size());
        names.push_back(requested);
    }
    std::string why = names.front() + ": missing";
    stream.infoless = true;
    for (const std::string& name : names) {
        if (const MessageTopic* topic = file.find(name); topic != nullptr && !topic->messages.empty()) {
            stream.infoless = false;
            if (name == requested && topic->type != kInfoType) {
                stream.noLens =
                    "info: " + requested + " is " + topic->type + " (allowed: a topic of " + kInfoType + ")";
                return nullptr;
            }
            return topic;
        }
        const std::string fault = file.faultOf(name);
        stream.infoless = stream.infoless && fault.empty();
        why = fault.empty() ? why : name + ": " + fault;
    }
    stream.noLens = why + " (allowed: sensor_msgs/CameraInfo next to " + stream.name +
                    ", or info=TOPIC or intrinsics=FILE after the file name)";
    return nullptr;
}

// Calls use(index) for the first messages of a topic until it returns no fault: a camera may begin with an
// empty image, or before its calibration is loaded. Returns the first fault, empty = none.
template <class Use>
std::string firstUsable(const MessageTopic& topic, Use&& use) {
    constexpr size_t kMaxTried = 5;
    std::string first;
    for (size_t i = 0; i < std::min(kMaxTried, topic.messages.size()); ++i) {
        std::string fault;
        try {
            fault = use(i);
        } catch (const Error& e) {
            fault = e.what();
        }
        if (fault.empty()) {
            return "";
        }
        first = first.empty() ? fault : first;
    }
    return first;
}

// Pixel centres are at integers.
glm::dvec2 middleOf(const ImageStream& stream) {
    return {0.5 * (stream.width - 1.0), 0.5 * (stream.height - 1.0)};
}

// Of a camera_info that states no size: that of the images, if the lens looks through their middle.
void takeImageSize(Intrinsics& lens, const ImageStream& stream) {
    // Of the principal point from the middle, in widths. A lens of its own size is off by up to 0.087 (Azure
    // Kinect); 640x480 is off by 0.1 in 800x600, by 0.12 in 848x480, and 640x360 by 0.12 in 640x480.
    constexpr double kMaxOff = 0.09;
    const glm::dvec2 middle = middleOf(stream);
    if (std::abs(lens.cx - middle.x) <= kMaxOff * stream.width &&
        std::abs(lens.cy - middle.y) <= kMaxOff * stream.height) {
        lens.width = stream.width;
        lens.height = stream.height;
    }
}

// A lens that states no size and whose principal point is not near the middle of the images.
std::string whyUnsized(const Intrinsics& lens, const ImageStream& stream) {
    const auto point = [](double x, double y) {
        return "(" + significant(x, 4) + ", " + significant(y, 4) + ")";
    };
    const bool inside =
        lens.cx >= 0.5 && lens.cy >= 0.5 && lens.cx < kMaxImageWidth && lens.cy < kMaxImageHeight;
    const auto twice = [](double middle) { return 2 * static_cast<uint32_t>(std::lround(middle + 0.25)); };
    const glm::dvec2 middle = middleOf(stream);
    return "width, height: 0, with the principal point " + point(lens.cx, lens.cy) +
           (inside ? ", as in the middle of images of " + sizeText(twice(lens.cx), twice(lens.cy)) : "") +
           " (allowed: the size of the images of " + stream.name + ", " +
           sizeText(stream.width, stream.height) + ", whose middle is " + point(middle.x, middle.y) +
           "; or intrinsics=FILE after the file name)";
}

// Why the lens is none of these images; empty = it is.
std::string whyNotLens(const Intrinsics& lens, const ImageStream& stream) {
    if (lens.width == 0 && lens.height == 0) {
        return whyUnsized(lens, stream);
    }
    if (lens.width > kMaxImageWidth || lens.height > kMaxImageHeight) {
        return sizeText(lens.width, lens.height) + " (allowed: at most 3840x2160 pixels)";
    }
    if (stream.width != lens.width || stream.height != lens.height) {
        return sizeText(lens.width, lens.height) + " where the images of " + stream.name + " have " +
               sizeText(stream.width, stream.height) +
               " (allowed: the images' size, binning and region of interest applied)";
    }
    return lens.invertible() ? ""
                             : "distortion (allowed: coefficients that can be inverted over the whole image)";
}

void readLens(MessageFile& file, const std::string& requested, ImageStream& stream) {
    const MessageTopic* topic = infoOf(file, requested, stream);
    if (topic == nullptr) {
        return;
    }
    const std::string fault = firstUsable(*topic, [&](size_t index) {
        ros::CameraInfo info = ros::cameraInfo(file.read(*topic, index));
        const bool sized = info.rectified.width != 0 || info.rectified.height != 0;
        if (!sized) {
            takeImageSize(info.raw, stream);
            takeImageSize(info.rectified, stream);
        }
        const Intrinsics lens = info.lens(namedRectified(stream.name));
        const std::string why = whyNotLens(lens, stream);
        if (why.empty()) {
            stream.lens = lens;
            stream.info = static_cast<size_t>(topic - file.topics().data());
            stream.raw = info.raw;
            stream.rectified = namedRectified(stream.name);
            stream.turned = info.turned;
            stream.skew = stream.rectified ? info.rectifiedSkew : info.rawSkew;
            stream.unsized = !sized;
            stream.shift = info.shift;
        }
        return why;
    });
    stream.noLens = fault.empty() ? "" : topic->name + ": " + fault;
}

// Format and size of the images.
std::string readHeader(MessageFile& file, const MessageTopic& topic, size_t index, ImageStream& stream) {
    const MessageCursor message = file.read(topic, index);
    const ros::Image image = stream.compressed ? ros::compressedImage(message) : ros::image(message);
    stream.frame = image.frame;
    stream.encoding = stream.compressed ? image.format : image.encoding;
    stream.content = ros::content(image);
    stream.format = ros::colourFormat(image);
    const auto size = ros::sizeOf(image);
    stream.width = size ? size->first : 0;
    stream.height = size ? size->second : 0;
    stream.metres = ros::holdsMetres(image);
    if (stream.width > 0 && stream.height > 0) {
        return "";
    }
    return size || image.data.empty() ? "an empty image" : "a compressed image without a header that is read";
}

// By the first message whose lens is known, else by the first one that can be read.
ImageStream usableStream(MessageFile& file, const std::string& info, const ImageStream& named) {
    const MessageTopic& topic = file.topics()[named.topic];
    ImageStream stream = named;
    std::optional<ImageStream> readable;
    const std::string fault = firstUsable(topic, [&](size_t index) {
        stream = named;
        std::string why = readHeader(file, topic, index, stream);
        if (!why.empty()) {
            return why;
        }
        readLens(file, info, stream);
        readable = readable ? readable : std::optional(stream);
        return stream.noLens;
    });
    if (fault.empty() || readable) {
        return fault.empty() ? stream : *readable;
    }
    stream.noLens = stream.name + ": " + fault;
    return stream;
}

// Whether a name of depth and colour is that of a camera: another image below it names depth again.
bool namesCamera(const std::string& folder, const std::vector<ImageStream>& streams) {
    return !folder.empty() && std::ranges::any_of(streams, [&](const ImageStream& stream) {
        return stream.content == ros::Content::Depth && stream.name.starts_with(folder) &&
               namedRole(stream.name.substr(folder.size())) == NamedRole::Depth;
    });
}

void settleRole(ImageStream& stream, const std::vector<ImageStream>& streams) {
    stream.painted = namedDepthImage(stream.name);
    if (stream.role == NamedRole::Either) {
        const bool depth = stream.content == ros::Content::Depth;
        stream.painted = !depth && !namesCamera(folderOfEither(stream.name), streams);
        stream.role = depth || stream.painted ? NamedRole::Depth : NamedRole::Colour;
    }
    const bool other = stream.content != ros::Content::Depth && !stream.painted; // of a camera of depth
    const auto isDepth = [](const ImageStream& s) {
        return s.content == ros::Content::Depth &&
               (s.role == NamedRole::Depth || s.role == NamedRole::Either) && !namedDistance(s.name);
    };
    if (stream.role == NamedRole::Depth &&
        (other || (namedDistance(stream.name) && std::ranges::any_of(streams, isDepth)))) {
        stream.role = NamedRole::None;
    }
}

// The colour stream, of depth's frame or of any, whose lens may be that of depth that is aligned to it; null
// = none, or several lenses.
const ImageStream* lensOwner(const ImageStream& depth, const std::vector<ImageStream>& streams,
                             bool ofFrame) {
    const ImageStream* owner = nullptr;
    for (const ImageStream& colour : streams) {
        const bool frame = !ofFrame || (!depth.frame.empty() && colour.frame == depth.frame);
        const bool fits = frame && colour.content == ros::Content::Colour && colour.lens && !colour.painted &&
                          colour.width == depth.width && colour.height == depth.height;
        if (fits && owner != nullptr && !sameLens(*owner->lens, *colour.lens)) {
            return nullptr;
        }
        owner = fits && owner == nullptr ? &colour : owner;
    }
    return owner;
}

// Recordings often have aligned depth, colour and colour's lens only.
void takeColourLens(const MessageFile& file, ImageStream& depth, const std::vector<ImageStream>& streams) {
    if (depth.content != ros::Content::Depth || !depth.infoless || !namedRegistered(depth.name)) {
        return;
    }
    const ImageStream* colour = lensOwner(depth, streams, true);
    if (colour == nullptr) {
        const ImageStream* other = lensOwner(depth, streams, false);
        depth.noLens += other == nullptr ? ""
                                         : "; if depth is seen by the lens of " + other->name +
                                               ": info=" + file.topics()[*other->info].name;
        return;
    }
    depth.lens = colour->lens;
    depth.raw = colour->raw;
    depth.info = colour->info;
    depth.rectified = colour->rectified;
    depth.turned = colour->turned;
    depth.unsized = colour->unsized;
    depth.shift = colour->shift;
    depth.lensOf = colour->name;
    depth.noLens.clear();
}

} // namespace

bool mayBeDepth(const ImageStream& stream) {
    const bool named = stream.role == NamedRole::Depth || strcasecmp(stream.encoding.c_str(), "mono16") != 0;
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
        streams.push_back(usableStream(file, info, stream));
    }
    for (ImageStream& stream : streams) {
        settleRole(stream, streams);
    }
    for (ImageStream& stream : streams) {
        takeColourLens(file, stream, streams);
    }
    return streams;
}

} // namespace fathom
