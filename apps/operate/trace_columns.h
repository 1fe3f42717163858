// SPDX-License-Identifier: Apache-2.0
// A trace of thousands of samples as one range per pixel column, which keeps every spike. Only new samples
// are looked at, because a window frame adds a few of ten thousand.
#pragma once

#include "apps/operate/run_view.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <deque>
#include <limits>

namespace fathom::operate {

// Window thread.
class TraceColumns {
public:
    // Curves of the force, then the same of the torque.
    enum Curve : size_t { X, Y, Z, Size, Residual };
    static constexpr size_t kOfPart = Residual + 1;

    // Adds what is new in the trace. count: columns of RunView::kSpan; they stay where they are in time, so
    // that a spike moves by whole columns. Another count, or another number of restarts (RunView), begins
    // anew.
    void follow(const std::deque<TraceSample>& trace, uint64_t restarts, int count);

    // Calls draw(first, last, low, high) from left to right for columns with samples; the newest sample is
    // count - 1: the range of a curve, extended to the last value of the previous column. Adjacent columns
    // with the same range are merged. Leaves out values that are not known.
    template <class Draw>
    void each(size_t curve, Draw&& draw) const {
        int first = 0, last = -1;
        Range range{0.0f, 0.0f};
        for (const Column& column : columns_) {
            const int at = static_cast<int>(column.index - columns_.back().index) + count_ - 1;
            const Range& here = column.ranges[curve];
            if (last >= first && last + 1 == at && here.low == range.low && here.high == range.high) {
                last = at;
                continue;
            }
            if (last >= first) {
                draw(first, last, range.low, range.high);
            }
            first = at;
            last = std::isnan(here.low) ? at - 1 : at;
            range = here;
        }
        if (last >= first) {
            draw(first, last, range.low, range.high);
        }
    }

private:
    struct Range {
        float low, high;
    };
    using Values = std::array<float, 2 * kOfPart>;
    struct Column {
        int64_t index = 0; // since time 0
        std::array<Range, 2 * kOfPart> ranges;
    };
    static Values valuesOf(const TraceSample& sample);
    void take(const TraceSample& sample);

    std::deque<Column> columns_;
    Values last_{};
    double takenTo_ = -std::numeric_limits<double>::infinity(); // [s]
    uint64_t restarts_ = 0;
    int count_ = 0;
};

} // namespace fathom::operate
