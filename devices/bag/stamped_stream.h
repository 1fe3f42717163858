// SPDX-License-Identifier: Apache-2.0
// Finds the message of a topic by its header's stamp.
#pragma once

#include "devices/bag/message_file.h"

#include <optional>
#include <vector>

namespace fathom {

// Reads headers near the time of recording only, each once, so that a long file is not read in advance.
class StampedStream {
public:
    StampedStream(MessageFile& file, const MessageTopic& topic);

    // The message whose stamp [s] is nearest, at most `within` away; recordedAt [ns]: of the message asked
    // for.
    std::optional<size_t> nearest(double stamp, uint64_t recordedAt, double within);
    // The header's stamp [s]; the time of recording when the first header has none, or after
    // useRecordingTime().
    double stampOf(size_t index);
    bool stamped() const { return stamped_; }
    void useRecordingTime();
    double medianPeriod() const; // [s] of the recording; 0 = unknown

private:
    MessageFile& file_;
    const MessageTopic& topic_;
    std::vector<double> stamps_; // NaN: not read yet
    bool stamped_ = true;
};

} // namespace fathom
