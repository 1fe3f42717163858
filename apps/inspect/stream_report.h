// SPDX-License-Identifier: Apache-2.0
// The streams of a file of messages: what each topic holds, how often, and through which lens.
#pragma once

#include "devices/bag/image_stream.h"

#include <iosfwd>
#include <string>
#include <vector>

namespace fathom {

// Times between the messages of a topic, by the clock that recorded them.
struct Rate {
    double perSecond = 0.0;  // 0: fewer than two messages
    double longestGap = 0.0; // [s]
    double at = 0.0;         // [s] from the first message to the start of the longest gap
    size_t gaps = 0;         // intervals over 1.5 times the median
    static Rate of(const std::vector<MessageEntry>& messages);
};

// "640x480, fx 570.3 fy 570.3 cx 319.5 cy 239.5, no distortion".
std::string lensText(const Intrinsics& lens);

// One row per topic, most messages first; a lens, or why there is none, below each topic of images. Damaged
// messages of one topic do not hide the others.
void writeStreams(MessageFile& file, const std::string& infoTopic, std::ostream& out);

} // namespace fathom
