// SPDX-License-Identifier: Apache-2.0
// Describes the chosen streams of a file, what may be wrong with them, and what is not played.
#pragma once

#include "devices/bag/stream_choice.h"
#include "devices/recorded/source_options.h"

#include <string>
#include <vector>

namespace fathom {

// Summary and warnings of StreamChoice, for the streams of one file. One thread.
class StreamDescription {
public:
    // streams: all of the file. The arguments must outlive it.
    StreamDescription(const MessageFile& file, const SourceOptions& options,
                      const std::vector<ImageStream>& streams);
    // What was chosen, and what else there is, in one line.
    std::string summary(const StreamChoice& choice) const;
    // Streams that may show colour and are not read, or not taken for it.
    std::string unread() const;
    // Why depth that is named as aligned to colour may have the lens of raw depth; empty = it may not.
    static std::string alignedWarning(const ImageStream& depth, const ImageStream& colour);
    // Adds what may be wrong with the images that are played.
    void addWarnings(StreamChoice& choice) const;

private:
    std::string robotsWarning(const ImageStream& depth, const ImageStream& colour) const;
    void warnOf(const ImageStream& stream, std::vector<std::string>& warnings) const;

    const MessageFile& file_;
    const SourceOptions& options_;
    const std::vector<ImageStream>& streams_;
};

} // namespace fathom
