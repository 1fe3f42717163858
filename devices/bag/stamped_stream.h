// SPDX-License-Identifier: Apache-2.0
// Finds the message of a topic by its header's stamp.
#pragma once

#include "devices/bag/message_file.h"

#include <optional>
#include <vector>

namespace fathom {

// Reads headers near the time of recording or of a binary search only, each once, so that a long file is not
// read in advance.
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
    // Lets nearest() search the stamps of all messages, which rise, and not only those near recordedAt.
    void searchAll() { searchesAll_ = true; }
    // [s] Between two messages: of the stamps where these rise, else of the recording; 0 = unknown.
    double period();
    // Whether messages were recorded when they were sent, as far as the stamps tell; not so where a program
    // wrote the file later. True where the stamps say nothing.
    bool recordedInTime();
    // Why stamps that rise are no seconds, as far as the times of recording tell: they are numbers of frames,
    // or in another unit. Empty = they may be seconds.
    std::string whyNoSeconds();
    // The first message so many seconds after the first one, by the stamps where it was not recordedInTime().
    size_t firstAfter(double seconds);
    // Whether a message was recorded at most `within` [s] from a time [ns].
    bool hasRecorded(uint64_t time, double within) const;

private:
    struct Rise {
        double period, span; // [s]; period 0: the stamps do not rise
    };
    const Rise& rise();
    double recordedPeriod() const; // [s] median; 0 = unknown
    size_t firstFrom(double stamp);

    MessageFile& file_;
    const MessageTopic& topic_;
    std::vector<double> stamps_; // NaN: not read yet
    bool stamped_ = true, searchesAll_ = false;
    std::optional<Rise> rise_;
};

} // namespace fathom
