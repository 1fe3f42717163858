// SPDX-License-Identifier: Apache-2.0
// Sentences of StreamChooser about the streams of a file.
#include "devices/bag/stream_choice.h"

#include "devices/bag/topic_words.h"
#include "devices/recorded/lens_model.h"
#include "engine/types/number_text.h"
#include "engine/types/printed.h"

#include <algorithm>
#include <cmath>

namespace fathom {

std::string StreamChooser::describe(const StreamChoice& choice) const {
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

// Some drivers publish the lens of raw depth with the depth that they align to colour. Crops of colour, and
// one that is calibrated anew, have nearly its focal length; images of another size are resized.
std::string StreamChooser::alignedWarning(const ImageStream& depth, const ImageStream& colour) const {
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

// Streams that may show colour and are not read, or not taken for it.
std::string StreamChooser::unreadStreams() const {
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

// What may be wrong with images that are played.
void StreamChooser::warnOf(const ImageStream& stream, StreamChoice& choice) const {
    if (stream.skew != 0.0 && options_.intrinsics.empty()) {
        warnAboutSkew(choice.warnings, file_.topics()[*stream.info].name, stream.skew,
                      "the images of " + stream.name);
    }
    const auto words = camelWordsOf(stream.frame);
    const bool depthFrame = std::ranges::any_of(
        words, [](const std::string& word) { return useOf(word, true) == WordUse::Depth; });
    if (stream.content == ros::Content::Depth && stream.role == NamedRole::None && options_.depth.empty() &&
        !stream.name.ends_with("/compressedDepth") && !namedDistance(stream.name) && !depthFrame) {
        choice.warnings.push_back(stream.name + ": taken as depth by its encoding alone, " + stream.encoding +
                                  ", as neither topic nor frame names depth; depth=" + stream.name +
                                  " confirms it");
    }
}

// Where no image is depth.
void StreamChooser::refuseAll() const {
    std::string seen;
    for (const ImageStream& stream : streams_) {
        const bool unread = stream.encoding.empty() && !stream.noLens.empty();
        seen += (seen.empty() ? "" : ", ") +
                (unread ? stream.noLens : stream.name + " (" + stream.encoding + ")");
    }
    seen = seen.empty() ? "no images" + otherTopics() : seen;
    const std::string wanted = options_.depth.empty() ? "one of depth" : options_.depth;
    refuse("topics", seen,
           wanted + ": sensor_msgs/Image or CompressedImage with encoding " + ros::kDepthEncodings +
               (options_.depth.empty()
                    ? ", whose name is not one of infrared, inverse depth, or images computed from "
                      "depth (edges, gradient); mono16 under a name of depth; or depth=TOPIC; or "
                      "organised sensor_msgs/PointCloud2"
                    : ""));
}

// What a file without images holds.
std::string StreamChooser::otherTopics() const {
    constexpr size_t kMaxNamed = 6;
    std::string all;
    for (size_t i = 0; i < std::min(kMaxNamed, file_.topics().size()); ++i) {
        const MessageTopic& topic = file_.topics()[i];
        all += (i == 0 ? " but " : ", ") + topic.name + " (" + topic.type +
               (topic.messages.empty() ? ", no messages)" : ")");
    }
    return all + (file_.topics().size() > kMaxNamed ? " and more" : "");
}

} // namespace fathom
