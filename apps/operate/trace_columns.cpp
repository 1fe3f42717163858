// SPDX-License-Identifier: Apache-2.0
#include "apps/operate/trace_columns.h"

#include <algorithm>

namespace fathom::operate {

TraceColumns::Values TraceColumns::valuesOf(const TraceSample& sample) {
    Values values{};
    const TraceWrench delivered = sample.delivered();
    size_t at = 0;
    for (const auto part : {&TraceWrench::force, &TraceWrench::torque}) {
        const glm::vec3 &got = delivered.*part, &rest = sample.residual.*part;
        for (const float v : {got.x, got.y, got.z, glm::length(got), glm::length(rest)}) {
            values[at++] = v;
        }
    }
    return values;
}

void TraceColumns::take(const TraceSample& sample) {
    const Values values = valuesOf(sample);
    const auto index = static_cast<int64_t>(std::floor(sample.t * count_ / RunView::kSpan));
    if (columns_.empty() || columns_.back().index != index) {
        const Values& before = columns_.empty() ? values : last_;
        Column column;
        column.index = index;
        std::transform(before.begin(), before.end(), column.ranges.begin(), [](float v) {
            return Range{v, v};
        });
        columns_.push_back(column);
    }
    for (size_t i = 0; i < values.size(); ++i) {
        Range& range = columns_.back().ranges[i];
        range = {std::fmin(range.low, values[i]), std::fmax(range.high, values[i])}; // ignore NaN
    }
    last_ = values;
    takenTo_ = sample.t;
}

void TraceColumns::follow(const std::deque<TraceSample>& trace, uint64_t restarts, int count) {
    const bool follows = count == count_ && restarts == restarts_ && !trace.empty() &&
                         trace.front().t <= takenTo_ && takenTo_ <= trace.back().t;
    if (!follows) {
        columns_.clear();
        takenTo_ = -std::numeric_limits<double>::infinity();
        count_ = count;
        restarts_ = restarts;
    }
    const auto isNew = [](double t, const TraceSample& sample) { return t < sample.t; };
    for (auto at = std::upper_bound(trace.begin(), trace.end(), takenTo_, isNew); at != trace.end(); ++at) {
        take(*at);
    }
    while (!columns_.empty() && columns_.back().index - columns_.front().index >= count) {
        columns_.pop_front();
    }
}

} // namespace fathom::operate
