// SPDX-License-Identifier: Apache-2.0
#include "devices/bag/stream_description.h"

#include "devices/bag/compressed_colour.h"
#include "devices/bag/stream_names.h"
#include "devices/bag/topic_words.h"
#include "devices/recorded/lens_model.h"
#include "devices/recorded/range_images.h"
#include "engine/types/number_text.h"
#include "engine/types/printed.h"

#include <algorithm>
#include <cmath>

namespace fathom {

namespace {

// "/robot1" of "/robot1/camera/image_raw"; empty for a shorter topic, which begins with a camera's name.
std::string robotOf(const std::string& topic) {
    const std::string base = baseTopic(topic);
    const size_t end = base.find('/', 1);
    const bool longer = end != std::string::npos && base.find('/', end + 1) != std::string::npos;
    return longer ? base.substr(0, end) : "";
}

} // namespace

StreamDescription::StreamDescription(const MessageFile& file, const SourceOptions& options,
                                     const std::vector<ImageStream>& streams)
    : file_(file)
    , options_(options)
    , streams_(streams) {}

std::string StreamDescription::summary(const StreamChoice& choice) const {
    const auto named = [](const ImageStream& stream) { return stream.name + " (" + stream.encoding + ")"; };
    std::string words = "depth " + named(choice.depth);
    words += choice.colour ? ", colour " + named(*choice.colour) : ", no colour";
    words += !choice.colour ? "" : (choice.camera.registered ? ", registered" : ", by extrinsics");
    words += choice.depth.lensOf.empty() || !options_.intrinsics.empty()
                 ? ""
                 : ", depth with the lens of " + choice.depth.lensOf;
    for (const ImageStream* stream : {&choice.depth, choice.colour ? &*choice.colour : nullptr}) {
        if (stream != nullptr && stream->unsized && options_.intrinsics.empty()) {
            words += ", " + file_.topics()[*stream->info].name +
                     " without width and height (taken: " + sizeText(stream->width, stream->height) + ")";
        }
    }
    std::string rest;
    for (const ImageStream& stream : streams_) {
        if (stream.topic != choice.depth.topic && (!choice.colour || stream.topic != choice.colour->topic)) {
            rest += (rest.empty() ? "; not used: " : ", ") + named(stream);
        }
    }
    return words + rest;
}

std::string StreamDescription::unread() const {
    std::string all;
    const auto add = [&](const std::string& name, const std::string& what) {
        all += (all.empty() ? "" : ", ") + name + " (" + what + ")";
    };
    for (const ImageStream& stream : streams_) {
        if (stream.content == ros::Content::None) {
            add(stream.name, stream.encoding);
        } else if (stream.content == ros::Content::Colour && stream.painted) {
            add(stream.name,
                stream.encoding + ", named as painted depth; colour=" + stream.name + " plays it");
        }
    }
    for (const MessageTopic& topic : file_.topics()) {
        const bool video = topic.type.ends_with("Packet") || topic.type.ends_with("Video") ||
                           (topic.type.ends_with("Image") && !topic.type.starts_with("sensor_msgs/"));
        if (video && !topic.messages.empty()) {
            add(topic.name, topic.type);
        }
    }
    return all;
}

// Some drivers publish the lens of raw depth with the depth that they align to colour. Crops of colour, and
// one that is calibrated anew, have nearly its focal length; images of another size are resized.
std::string StreamDescription::alignedWarning(const ImageStream& depth, const ImageStream& colour) {
    constexpr double kMaxOther = 0.1;
    const bool toColour = depth.frame == colour.frame || depth.name.find("to_color") != std::string::npos ||
                          depth.name.find("to_rgb") != std::string::npos;
    if (!namedRegistered(depth.name) || !toColour || !depth.lens || !colour.lens ||
        depth.rectified != colour.rectified || depth.width != colour.width || depth.height != colour.height ||
        std::abs(depth.lens->fx / colour.lens->fx - 1.0) <= kMaxOther) {
        return "";
    }
    return depth.name +
           printed(" (fx %.1f) is named as aligned to colour, but has another lens than ", depth.lens->fx) +
           colour.name + printed(" (fx %.1f)", colour.lens->fx) +
           ": its camera_info may be that of the raw depth; intrinsics=FILE after the file name replaces "
           "it";
}

// Robots of one kind have equal frames, and a recording of several has one tf, which relates any depth to any
// colour. Frames that begin as their topics are told apart.
std::string StreamDescription::robotsWarning(const ImageStream& depth, const ImageStream& colour) const {
    const std::string ofDepth = robotOf(depth.name), ofColour = robotOf(colour.name);
    const auto hasMore = [&](const std::string& robot) {
        return std::ranges::any_of(file_.topics(), [&](const MessageTopic& topic) {
            return topic.name.starts_with(robot + "/") && topic.name != depth.name &&
                   topic.name != colour.name;
        });
    };
    const auto namesRobot = [](const ImageStream& stream, const std::string& robot) {
        return stream.frame.find(robot.substr(1)) != std::string::npos;
    };
    const bool asked = !options_.depth.empty() && !options_.colour.empty();
    if (asked || ofDepth.empty() || ofColour.empty() || ofDepth == ofColour || !hasMore(ofDepth) ||
        !hasMore(ofColour) || namedOneCamera(depth.name, colour.name) || namesRobot(depth, ofDepth) ||
        namesRobot(colour, ofColour)) {
        return "";
    }
    return depth.name + " and " + colour.name + " may be of two robots, " + ofDepth + " and " + ofColour +
           ", whose frames have equal names; depth=TOPIC and colour=TOPIC choose others or confirm these";
}

void StreamDescription::addWarnings(StreamChoice& choice) const {
    warnOf(choice.depth, choice.warnings);
    if (choice.colour) {
        warnOf(*choice.colour, choice.warnings);
        if (const std::string robots = robotsWarning(choice.depth, *choice.colour); !robots.empty()) {
            choice.warnings.push_back(robots);
        }
    }
    const std::string axis = axisWarning(choice.depth.name, "a file of the lens (intrinsics=FILE)");
    if (!axis.empty() && !choice.rangeImages) {
        choice.warnings.push_back(axis);
    }
}

void StreamDescription::warnOf(const ImageStream& stream, std::vector<std::string>& warnings) const {
    if (stream.skew != 0.0 && options_.intrinsics.empty()) {
        warnAboutSkew(warnings, file_.topics()[*stream.info].name, stream.skew,
                      "the images of " + stream.name);
    }
    const bool packed = stream.compressed && stream.content == ros::Content::Colour;
    if (const std::string swapped = packed ? redAndBlueWarning(stream.encoding) : ""; !swapped.empty()) {
        warnings.push_back(stream.name + ": " + swapped);
    }
    const auto words = camelWordsOf(stream.frame);
    const bool depthFrame = std::ranges::any_of(
        words, [](const std::string& word) { return useOf(word, true) == WordUse::Depth; });
    if (stream.content == ros::Content::Depth && stream.role == NamedRole::None && options_.depth.empty() &&
        !stream.name.ends_with("/compressedDepth") && !namedDistance(stream.name) && !depthFrame) {
        warnings.push_back(stream.name + ": taken as depth by its encoding alone, " + stream.encoding +
                           ", as neither topic nor frame names depth; depth=" + stream.name + " confirms it");
    }
}

} // namespace fathom
