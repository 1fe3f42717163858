// SPDX-License-Identifier: Apache-2.0
// Which image streams of a file of messages may be depth, and which may be colour.
#pragma once

#include "devices/bag/image_stream.h"
#include "devices/recorded/source_options.h"

#include <string>
#include <vector>

namespace fathom {

// A stream that may be depth, or one that may be colour.
struct StreamCandidate {
    const ImageStream* stream; // of StreamCandidates::streams()
    int fit;                   // how well the name fits; 0 only for grey
};

// By the encodings and names of the streams, and by the options. One thread.
class StreamCandidates {
public:
    // Fits of names that say what the images hold.
    static constexpr int kDepthName = 2, kColourName = 3;

    // Reads the streams with imageStreams().
    StreamCandidates(MessageFile& file, const SourceOptions& options);
    // All streams of images, whatever they hold.
    const std::vector<ImageStream>& streams() const { return streams_; }
    // Never empty: throws BadInput that names the file and what it holds where no image is depth.
    std::vector<StreamCandidate> depths() const;
    // Empty where the options exclude colour. Throws BadInput where the topic that they name is no colour.
    std::vector<StreamCandidate> colours() const;
    // Of a file without colour; never null. Throws as depths().
    const ImageStream* bestDepth() const;

private:
    std::string otherTopics() const;
    [[noreturn]] void refuseAll() const;
    [[noreturn]] void refuse(const std::string& field, const std::string& value,
                             const std::string& allowed) const;

    const MessageFile& file_;
    const SourceOptions& options_;
    std::vector<ImageStream> streams_;
};

} // namespace fathom
