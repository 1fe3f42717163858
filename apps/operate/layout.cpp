// SPDX-License-Identifier: Apache-2.0
#include "apps/operate/layout.h"

#include <algorithm>

namespace fathom::operate {

Rooms arrange(ImVec2 size, double scale, bool timeLine) {
    constexpr int kGap = 6;
    const int width = static_cast<int>(size.x), height = static_cast<int>(size.y);
    const int head = static_cast<int>(58 * scale), right = std::min(static_cast<int>(376 * scale), width / 2);
    const int traces = std::min(static_cast<int>(172 * scale), height / 3);
    const int gauges = std::min(static_cast<int>(168 * scale), height / 3);
    const int left = width - right - kGap, inset = std::max(60, std::min(right * 9 / 16, height / 3));
    Rooms rooms;
    rooms.head = {0, 0, width, head};
    const int strip = timeLine ? static_cast<int>(76 * scale) + kGap : 0;
    rooms.large = {0, head + kGap, left, height - head - traces - strip - 2 * kGap};
    rooms.timeLine = {0, height - traces - strip, left, std::max(0, strip - kGap)};
    rooms.traces = {0, height - traces, left, traces};
    rooms.inset = {left + kGap, head + kGap, right, inset};
    rooms.gauges = {left + kGap, head + inset + 2 * kGap, right, gauges};
    const int top = rooms.gauges.y + gauges + kGap;
    rooms.tabs = {left + kGap, top, right, std::max(40, height - top)};
    return rooms;
}

} // namespace fathom::operate
