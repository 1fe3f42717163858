// SPDX-License-Identifier: Apache-2.0
#include "engine/cycle/cadence_trace.h"

namespace fathom {

CadenceTrace::CadenceTrace(const std::filesystem::path& file, const std::vector<std::string>& passes)
    : trace_(file)
    , frames_(trace_.track("frame"))
    , device_(trace_.track("device"))
    , contact_(trace_.track("contact"))
    , haptic_(trace_.track("haptic")) {
    for (const std::string& pass : passes) {
        passes_.push_back(trace_.keep(pass));
    }
}

void CadenceTrace::frame(const FrameReport& report) noexcept {
    const FrameReport::Times& at = report.times;
    const TraceDetail index{"index", static_cast<double>(report.index)};
    frames_.instant("captured", at.started, index);
    frames_.span("upload", at.started, at.uploaded, index);
    if (report.unchanged) {
        return;
    }
    frames_.span("device", at.submitted, at.completed, index);
    frames_.span("publish", at.completed, at.published, index);
    frames_.instant("answerable", at.answerable, index);
    frames_.span("grid", at.collected, at.published, index); // inside the span of publish
    auto begin = at.submitted;
    for (size_t i = 0; i < passes_.size() && i < report.passMs.size(); ++i) {
        const std::chrono::duration<double, std::milli> length(report.passMs[i]);
        const auto end = begin + std::chrono::duration_cast<std::chrono::nanoseconds>(length);
        device_.span(passes_[i], begin, end, {"placed", 0.0, "submit time + device intervals"});
        begin = end;
    }
}

void CadenceTrace::query(TraceTime begin, TraceTime end, size_t spheres) noexcept {
    contact_.frequentSpan("query", begin, end, {"spheres", static_cast<double>(spheres)});
}

void CadenceTrace::step(TraceTime begin, TraceTime end, double lateSeconds) noexcept {
    haptic_.frequentSpan("turn", begin, end, {"woken_late_us", lateSeconds * 1e6});
}

} // namespace fathom
