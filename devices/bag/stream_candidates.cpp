// SPDX-License-Identifier: Apache-2.0
#include "devices/bag/stream_candidates.h"

#include "devices/recorded/range_images.h"
#include "engine/types/error.h"

#include <algorithm>
#include <tuple>

namespace fathom {

namespace {

// How well a name fits a use: 2 names it, 1 says nothing, 0 names another.
int nameFit(NamedRole role, NamedRole use) {
    return role == use ? 2 : (role == NamedRole::None ? 1 : 0);
}

} // namespace

StreamCandidates::StreamCandidates(MessageFile& file, const SourceOptions& options)
    : file_(file)
    , options_(options)
    , streams_(imageStreams(file, options.info)) {}

std::vector<StreamCandidate> StreamCandidates::depths() const {
    std::vector<StreamCandidate> all;
    for (const ImageStream& stream : streams_) {
        const bool named = stream.name == options_.depth;
        const bool fit = options_.depth.empty() ? mayBeDepth(stream) : named;
        const int how = named ? kDepthName : nameFit(stream.role, NamedRole::Depth);
        if (stream.content == ros::Content::Depth && fit && how > 0) {
            all.push_back({&stream, how});
        }
    }
    if (!all.empty()) {
        return all;
    }
    refuseAll();
}

std::vector<StreamCandidate> StreamCandidates::colours() const {
    std::vector<StreamCandidate> all;
    if (options_.colour == "none") {
        return all;
    }
    for (const ImageStream& stream : streams_) {
        const bool usable = stream.content == ros::Content::Colour || stream.content == ros::Content::Grey;
        const bool named = stream.name == options_.colour;
        if (!usable || (!options_.colour.empty() && !named) || (!named && stream.painted)) {
            continue;
        }
        // Grey comes last: it is no colour, but shows something.
        const bool grey = stream.content == ros::Content::Grey;
        all.push_back({&stream, grey ? 0 : 1 + nameFit(stream.role, NamedRole::Colour)});
    }
    if (all.empty() && !options_.colour.empty()) {
        refuse("colour", options_.colour, std::string("a topic with encoding ") + ros::kColourEncodings);
    }
    return all;
}

const ImageStream* StreamCandidates::bestDepth() const {
    using Score = std::tuple<int, bool, bool, bool, bool>;
    Score best;
    const ImageStream* depth = nullptr;
    for (const auto& [d, how] : depths()) {
        const Score score{how, d->lens.has_value(), rangeName(d->name) != RangeName::Surely,
                          namedPlainly(d->name), !d->compressed};
        if (depth == nullptr || score > best) {
            best = score;
            depth = d;
        }
    }
    return depth;
}

// Where no image is depth.
void StreamCandidates::refuseAll() const {
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
std::string StreamCandidates::otherTopics() const {
    constexpr size_t kMaxNamed = 6;
    std::string all;
    for (size_t i = 0; i < std::min(kMaxNamed, file_.topics().size()); ++i) {
        const MessageTopic& topic = file_.topics()[i];
        all += (i == 0 ? " but " : ", ") + topic.name + " (" + topic.type +
               (topic.messages.empty() ? ", no messages)" : ")");
    }
    return all + (file_.topics().size() > kMaxNamed ? " and more" : "");
}

void StreamCandidates::refuse(const std::string& field, const std::string& value,
                              const std::string& allowed) const {
    throw BadInput(file_.file().string(), field, value, allowed);
}

} // namespace fathom
