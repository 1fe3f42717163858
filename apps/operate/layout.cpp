// SPDX-License-Identifier: Apache-2.0
#include "apps/operate/layout.h"

#include <algorithm>
#include <cmath>

namespace fathom::operate {

namespace {

constexpr int kGap = 6; // [pixels] between parts

Rooms engineerRooms(const LayoutInput& input) {
    const double scale = input.scale;
    const int width = static_cast<int>(input.size.x), height = static_cast<int>(input.size.y);
    const int head = static_cast<int>(58 * scale), right = std::min(static_cast<int>(376 * scale), width / 2);
    const int traces = std::min(static_cast<int>(172 * scale), height / 3);
    const int gauges = std::min(static_cast<int>(168 * scale), height / 3);
    const int left = width - right - kGap, inset = std::max(60, std::min(right * 9 / 16, height / 3));
    Rooms rooms;
    rooms.head = {0, 0, width, head};
    const int strip = input.timeLine ? static_cast<int>(76 * scale) + kGap : 0;
    rooms.large = {0, head + kGap, left, height - head - traces - strip - 2 * kGap};
    rooms.timeLine = {0, height - traces - strip, left, std::max(0, strip - kGap)};
    rooms.traces = {0, height - traces, left, traces};
    rooms.inset = {left + kGap, head + kGap, right, inset};
    rooms.gauges = {left + kGap, head + inset + 2 * kGap, right, gauges};
    const int top = rooms.gauges.y + gauges + kGap;
    rooms.tabs = {left + kGap, top, right, std::max(40, height - top)};
    return rooms;
}

// Views as large as they can be: the column at the right takes what a 4:3 camera leaves free.
Rooms pilotRooms(const LayoutInput& input) {
    const double scale = input.scale;
    const int width = static_cast<int>(input.size.x), height = static_cast<int>(input.size.y);
    const int strip = static_cast<int>(40 * scale);
    const int timeLine = input.timeLine ? static_cast<int>(76 * scale) + kGap : 0;
    const int view = height - strip - timeLine - kGap;
    const int least = std::max(width * 22 / 100, static_cast<int>(130 * scale));
    const int right = std::clamp(width - view * 4 / 3 - kGap, least, std::max(least, width * 38 / 100));
    const int left = width - right - kGap;
    Rooms rooms;
    rooms.large = {0, 0, left, view};
    rooms.timeLine = {0, view + kGap, width, std::max(0, timeLine - kGap)};
    rooms.strip = {0, height - strip, width, strip};
    rooms.inset = {left + kGap, 0, right, std::min(right * 3 / 4, view * 2 / 5)};
    const int below = rooms.inset.height + kGap;
    const int stop = static_cast<int>(46 * scale);
    rooms.gap = {left + kGap, below, right, view - below - stop - kGap};
    rooms.stop = {left + kGap, view - stop, right, stop};
    const int tabs = std::min(std::max(right, static_cast<int>(376 * scale)), width);
    rooms.tabs = {width - tabs, below, tabs, view - below - stop - kGap};
    return rooms;
}

} // namespace

Rooms arrange(const LayoutInput& input) {
    return input.pilot ? pilotRooms(input) : engineerRooms(input);
}

double scaleThatFits(ImVec2 size, double wanted, bool pilot) {
    const double fits = pilot ? std::min(double{size.x} / 480.0, double{size.y} / 330.0)
                              : std::min(double{size.x} / 930.0, double{size.y} / 560.0);
    constexpr double kMin = 0.75, kMax = 4.0, kSteps = 8.0; // a font is made per step
    return std::clamp(std::min(wanted, std::floor(kSteps * fits) / kSteps), kMin, kMax);
}

} // namespace fathom::operate
