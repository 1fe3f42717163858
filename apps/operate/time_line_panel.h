// SPDX-License-Identifier: Apache-2.0
// The time line of a recording: a marker to drag over the recorded force, buttons and keys.
#pragma once

#include "apps/operate/console.h"
#include "apps/operate/theme.h"
#include "apps/operate/tick_log.h"

#include <vector>

namespace fathom::operate {

// Draws a recording as about a thousand columns.
class TimeLinePanel {
public:
    TimeLinePanel(const TickLog& log, double duration);

    // Window thread, inside an ImGui frame. Changes console.timeLine only.
    void handleKeys(Console& console) const;
    void draw(Console& console, const Fonts& fonts, ImVec2 at, ImVec2 size) const;

private:
    void drawButtons(Console& console) const;
    void drawStrip(Console& console) const;

    static constexpr size_t kColumns = 1024;
    struct Column {
        float force = 0.0f; // [N] largest force
        bool contact = false, guided = false, any = false;
    };
    std::vector<Column> columns_;
    std::vector<double> times_; // [s] times of the ticks
    float peak_ = 0.0f;         // [N] largest force of all columns
};

} // namespace fathom::operate
