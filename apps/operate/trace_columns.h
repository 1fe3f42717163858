// SPDX-License-Identifier: Apache-2.0
// A trace of thousands of samples as one stroke a column of pixels, so that no spike is lost.
#pragma once

#include "apps/operate/run_view.h"

#include <algorithm>

namespace fathom::operate {

// draw(column, low, high) for each column that has samples, from left to right: from the least to the
// greatest value(sample) there, and to the last one of the column before it. column(sample): where it falls;
// ascends.
template <class Column, class Value, class Draw>
void eachColumn(const std::deque<TraceSample>& trace, Column&& column, Value&& value, Draw&& draw) {
    for (size_t i = 0; i < trace.size();) {
        const int at = column(trace[i]);
        const float before = value(trace[i == 0 ? 0 : i - 1]);
        float low = before, high = before;
        for (; i < trace.size() && column(trace[i]) == at; ++i) {
            const float v = value(trace[i]);
            low = std::min(low, v);
            high = std::max(high, v);
        }
        draw(at, low, high);
    }
}

} // namespace fathom::operate
