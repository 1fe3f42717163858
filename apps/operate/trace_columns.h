// SPDX-License-Identifier: Apache-2.0
// Draws a trace of thousands of samples as one stroke per pixel column, which keeps every spike.
#pragma once

#include "apps/operate/run_view.h"

#include <algorithm>
#include <optional>

namespace fathom::operate {

// Calls draw(first, last, low, high) from left to right for columns with samples: the range of value(sample)
// in the column, extended to the last value of the previous column. Adjacent columns with the same range are
// merged. column(sample) must ascend.
template <class Column, class Value, class Draw>
void eachColumn(const std::deque<TraceSample>& trace, Column&& column, Value&& value, Draw&& draw) {
    struct Stroke {
        int first, last;
        float low, high;
    };
    std::optional<Stroke> stroke;
    const auto drawLast = [&] {
        if (stroke) {
            draw(stroke->first, stroke->last, stroke->low, stroke->high);
        }
    };
    for (size_t i = 0; i < trace.size();) {
        const int at = column(trace[i]);
        const float before = value(trace[i == 0 ? 0 : i - 1]);
        float low = before, high = before;
        for (; i < trace.size() && column(trace[i]) == at; ++i) {
            const float v = value(trace[i]);
            low = std::min(low, v);
            high = std::max(high, v);
        }
        if (stroke && stroke->last + 1 == at && stroke->low == low && stroke->high == high) {
            stroke->last = at;
            continue;
        }
        drawLast();
        stroke = {at, at, low, high};
    }
    drawLast();
}

} // namespace fathom::operate
