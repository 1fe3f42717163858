// SPDX-License-Identifier: Apache-2.0
#include "apps/operate/run_view.h"

#include "engine/cycle/step_record.h"

#include <algorithm>
#include <cmath>

namespace fathom::operate {

namespace {

constexpr double kSameBlock = 0.25; // [s] without a touch end a block
constexpr size_t kMaxBlocks = 12;
constexpr size_t kMaxTimedTicks = 1'000'000; // ticks whose times are kept; bounds the memory of long sessions

} // namespace

TraceWrench TraceSample::delivered() const {
    const bool known = std::isfinite(residual.force.x);
    return known ? TraceWrench{whole.force - residual.force, whole.torque - residual.torque} : whole;
}

TraceSample sampleOf(const TickRow& row) {
    const StepRecord& r = row.record;
    return {r.t,
            {glm::vec3(r.wrench.force), glm::vec3(r.wrench.torque)},
            {glm::vec3(r.residual.force), glm::vec3(r.residual.torque)},
            r.frame,
            r.state,
            r.guidance > 0.0,
            row.late};
}

void PeakHold::add(double t, float value, double span) {
    while (!falling_.empty() && falling_.back().second <= value) {
        falling_.pop_back();
    }
    falling_.emplace_back(t, value);
    while (t - falling_.front().first > span) {
        falling_.pop_front();
    }
}

bool RunView::refresh() {
    TickRow row;
    while (sink_.ticks().pop(row)) {
        take(row);
    }
    const bool fresh = sink_.scene().refresh();
    if (fresh) {
        seen_.captures.push_back(scene().t);
        while (scene().t - seen_.captures.front() > 1.0) {
            seen_.captures.pop_front();
        }
        if (!scene().report.unchanged) {
            passMs_ = scene().report.passMs;
        }
    }
    return fresh;
}

void RunView::rewind() {
    seen_ = {}; // a new run has a new clock
    ++restarts_;
}

void RunView::take(const TickRow& row) {
    if (seen_.ticks > 0 &&
        row.record.vanished > seen_.tick.record.vanished) { // the first row also counts earlier ones
        seen_.vanishedAt = row.record.t;
    }
    seen_.lostAt = row.hand.present ? seen_.lostAt : row.record.t;
    seen_.tick = row;
    ++seen_.ticks;
    seen_.late += row.late ? 1 : 0;
    if (seen_.micros.size() < kMaxTimedTicks) {
        seen_.micros.resize(seen_.micros.size() + 1);
        seen_.wokenLate.resize(seen_.micros.size());
    }
    seen_.micros[(seen_.ticks - 1) % kMaxTimedTicks] = static_cast<float>(row.micros);
    seen_.wokenLate[(seen_.ticks - 1) % kMaxTimedTicks] = static_cast<float>(row.wokenLate * 1e6);
    const StepRecord& r = row.record;
    if (row.driven && row.armStatus.known) {
        seen_.measured = Measured{r.t - row.armStatus.age, row.armStatus.posture};
    }
    seen_.trace.push_back(sampleOf(row));
    seen_.trace.back().fade = fadeReason();
    const TraceWrench felt = seen_.trace.back().delivered();
    seen_.ripple.add(r.t, r.frame, {dvec3(felt.force), dvec3(felt.torque)});
    seen_.force.add(r.t, glm::length(felt.force), kSpan);
    seen_.torque.add(r.t, glm::length(felt.torque), kSpan);
    while (r.t - seen_.trace.front().t > kSpan) {
        seen_.trace.pop_front();
    }
    noteDelay(r);
    noteBlocks(row);
}

FadeReason RunView::fadeReason() const {
    const StepRecord& record = seen_.tick.record;
    const bool fading = record.state == StepState::Fading;
    // An old frame stops a real arm, which then holds the forces off also when they have ramped out.
    if (isOld(record.sceneAge) && (fading || (seen_.tick.driven && record.frame >= 0))) {
        return FadeReason::OldFrame;
    }
    if ((seen_.tick.hand.buttons & kDeadManOpen) != 0) {
        return FadeReason::SwitchedOff;
    }
    if (seen_.tick.driven && seen_.tick.armStatus.state != ArmState::Follows) {
        return FadeReason::ArmStill;
    }
    if (!seen_.tick.hand.present) {
        return FadeReason::DeviceLost;
    }
    if (fading && regionsVanished()) {
        return FadeReason::RegionGone;
    }
    return deviceWasLost() ? FadeReason::DeviceWasLost : FadeReason::Unknown;
}

void RunView::noteDelay(const StepRecord& r) {
    constexpr double kSpanOfDelays = 1.0; // [s]
    if (r.frame > seen_.usedFrame && std::isfinite(r.sceneAge)) {
        seen_.delays.emplace_back(r.t, r.sceneAge);
    }
    seen_.usedFrame = r.frame;
    while (!seen_.delays.empty() && r.t - seen_.delays.front().first > kSpanOfDelays) {
        seen_.delays.pop_front();
    }
}

FrameDelay RunView::delay() const {
    if (seen_.delays.empty()) {
        return {};
    }
    std::vector<double> ages;
    for (const auto& [t, age] : seen_.delays) {
        ages.push_back(age);
    }
    std::sort(ages.begin(), ages.end());
    return {ages[ages.size() / 2], ages.back()};
}

void RunView::noteBlocks(const TickRow& row) {
    const StepRecord& r = row.record;
    for (uint32_t i = 0; i < r.touchCount; ++i) {
        const Touch& touch = r.touches[i];
        auto same = std::find_if(seen_.blocks.begin(), seen_.blocks.end(), [&](const Block& b) {
            return b.touch.kind == touch.kind && b.touch.fixture == touch.fixture &&
                   b.touch.leaf == touch.leaf && r.t - b.last < kSameBlock;
        });
        if (same == seen_.blocks.end()) {
            seen_.blocks.push_front({touch, r.frame, r.t, r.t});
            same = seen_.blocks.begin();
        }
        same->touch = touch;
        same->last = r.t;
        same->beyond = std::max(0.0, glm::dot(r.tool.position - r.device.position, touch.normal));
        same->deepest = std::max(same->deepest, same->beyond);
        same->force = glm::length(r.wrench.force);
    }
    while (seen_.blocks.size() > kMaxBlocks) {
        seen_.blocks.pop_back();
    }
}

Rates RunView::rates() const {
    Rates rates;
    if (seen_.trace.size() < 2) {
        return rates;
    }
    const double now = seen_.trace.back().t;
    size_t count = 0;
    double worst = 0.0, later = now;
    for (auto it = seen_.trace.rbegin(); it != seen_.trace.rend() && now - it->t <= 1.0; ++it) {
        worst = std::max(worst, later - it->t);
        later = it->t;
        ++count;
    }
    rates.hapticHz = now > later ? static_cast<double>(count - 1) / (now - later) : 0.0;
    rates.worstPeriodMs = worst * 1e3;
    if (seen_.captures.size() > 1 && seen_.captures.back() > seen_.captures.front()) {
        rates.cameraHz =
            static_cast<double>(seen_.captures.size() - 1) / (seen_.captures.back() - seen_.captures.front());
    }
    return rates;
}

} // namespace fathom::operate
