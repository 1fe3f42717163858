// SPDX-License-Identifier: Apache-2.0
// Where the parts of the window are, and how large its text can be.
#pragma once

#include "apps/operate/painter.h"

#include <imgui.h>

namespace fathom::operate {

// Rectangles of the window [pixels]; a part that a layout does not show is empty.
struct Rooms {
    PixelRect head, large, inset, gauges, tabs, traces, timeLine;
    PixelRect strip; // the pilot's forces
    PixelRect gap;   // in which the gap bar is
    PixelRect stop;  // the plate with the key for forces off
};

// What a layout depends on. scale: of the text.
struct LayoutInput {
    ImVec2 size; // [pixels] of the window
    double scale = 1.0;
    bool pilot = false;    // the pilot's layout, otherwise the engineer's
    bool timeLine = false; // there is a strip for it
};

// Parts do not overlap, with these exceptions: gap bar and stop plate of the engineer's layout are in the
// large view, the tabs of the pilot's over the right column.
Rooms arrange(const LayoutInput& input);

// The largest scale, in steps of an eighth and at most `wanted`, at which the text of a layout has room. From
// 0.75 to 4.
double scaleThatFits(ImVec2 size, double wanted, bool pilot);

inline ImVec2 cornerOf(const PixelRect& r) {
    return {static_cast<float>(r.x), static_cast<float>(r.y)};
}

inline ImVec2 sizeOf(const PixelRect& r) {
    return {static_cast<float>(r.width), static_cast<float>(r.height)};
}

} // namespace fathom::operate
