// SPDX-License-Identifier: Apache-2.0
// Sentences of StreamChooser about the streams of a file.
#include "devices/bag/stream_choice.h"

#include <algorithm>

namespace fathom {

std::string StreamChooser::describe(const StreamChoice& choice) const {
    const auto named = [](const ImageStream& stream) { return stream.name + " (" + stream.encoding + ")"; };
    std::string words = "depth " + named(choice.depth);
    words += choice.colour ? ", colour " + named(*choice.colour) : ", no colour";
    words += !choice.colour ? "" : (choice.camera.registered ? ", registered" : ", by extrinsics");
    for (const ImageStream* stream : {&choice.depth, choice.colour ? &*choice.colour : nullptr}) {
        if (stream != nullptr && stream->unsized && options_.intrinsics.empty()) {
            words += ", " + file_.topics()[*stream->info].name +
                     " without width and height (taken: " + std::to_string(stream->width) + "x" +
                     std::to_string(stream->height) + ")";
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

// Streams that may show colour and are not read, or not taken for it.
std::string StreamChooser::unreadStreams() const {
    std::string all;
    const auto add = [&](const std::string& name, const std::string& what) {
        all += (all.empty() ? "" : ", ") + name + " (" + what + ")";
    };
    for (const ImageStream& stream : streams_) {
        if (stream.content == ros::Content::None) {
            add(stream.name, stream.encoding);
        } else if (stream.content == ros::Content::Colour && namedDepthImage(stream.name)) {
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
