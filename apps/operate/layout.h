// SPDX-License-Identifier: Apache-2.0
// Where the parts of the window are.
#pragma once

#include "apps/operate/painter.h"

#include <imgui.h>

namespace fathom::operate {

// Rectangles of the window [pixels].
struct Rooms {
    PixelRect head, large, inset, gauges, tabs, traces, timeLine;
};

// size [pixels]; scale: of the text. timeLine: there is a strip for it.
Rooms arrange(ImVec2 size, double scale, bool timeLine);

inline ImVec2 cornerOf(const PixelRect& r) {
    return {static_cast<float>(r.x), static_cast<float>(r.y)};
}

inline ImVec2 sizeOf(const PixelRect& r) {
    return {static_cast<float>(r.width), static_cast<float>(r.height)};
}

} // namespace fathom::operate
