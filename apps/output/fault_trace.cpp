// SPDX-License-Identifier: Apache-2.0
#include "apps/output/fault_trace.h"

#include "apps/output/haptics_csv.h"
#include "engine/types/error.h"
#include "engine/types/log.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace fathom {

namespace {

constexpr double kMaxTicks = 20000.0; // buffer size at the highest rate that a scene may request

size_t ticksOf(double seconds, double period) {
    return static_cast<size_t>(std::clamp(std::ceil(seconds / period), 1.0, kMaxTicks));
}

} // namespace

FaultTrace::FaultTrace(std::filesystem::path folder, double period, RunSink& next)
    : ForwardingSink(next)
    , folder_(std::move(folder))
    , ring_(ticksOf(kSeconds, period)) {}

void FaultTrace::step(const TickRow& row, const ObeyedSet& obeyed) {
    keep(row);
    if (!row.record.finite && row.record.t >= quietUntil_) {
        quietUntil_ = row.record.t + kQuiet;
        write(row.record.t);
    }
    ForwardingSink::step(row, obeyed);
}

void FaultTrace::keep(const TickRow& row) {
    if (row.record.t < newest_) { // a new run, whose clock starts again
        seen_ = 0;
        quietUntil_ = 0.0;
    }
    newest_ = row.record.t;
    ring_[seen_++ % ring_.size()] = row.record;
}

void FaultTrace::write(double t) const {
    const std::filesystem::path path = folder_ / fmt::format("fault-{:.3f}.csv", t);
    try {
        HapticsCsv file(path);
        for (uint64_t i = seen_ - std::min<uint64_t>(seen_, ring_.size()); i < seen_; ++i) {
            const StepRecord& tick = ring_[i % ring_.size()];
            if (tick.t >= t - kSeconds) { // the buffer reaches further back after missed periods
                file.add(tick);
            }
        }
        file.commit();
        log::warn("at {:.2f} s a number is not finite: the ticks before it are in {}", t, path.string());
    } catch (const Error& e) {
        log::warn("at {:.2f} s a number is not finite, and the ticks before it are lost: {}", t, e.what());
    }
}

} // namespace fathom
