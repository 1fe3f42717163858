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
        captures_.push_back(scene().t);
        while (scene().t - captures_.front() > 1.0) {
            captures_.pop_front();
        }
        if (!scene().report.unchanged) {
            passMs_ = scene().report.passMs;
        }
    }
    return fresh;
}

void RunView::rewind() {
    tick_ = {};
    vanishedAt_ = lostAt_ = kNever; // a new run has a new clock
    measured_.reset();
    ticks_ = late_ = 0;
    ++restarts_;
    trace_.clear();
    force_.clear();
    torque_.clear();
    ripple_.clear();
    captures_.clear();
    delays_.clear();
    usedFrame_ = -1;
    blocks_.clear();
    micros_.clear();
    wokenLate_.clear();
}

void RunView::take(const TickRow& row) {
    if (ticks_ > 0 && row.record.vanished > tick_.record.vanished) { // the first row's count is of before
        vanishedAt_ = row.record.t;
    }
    lostAt_ = row.hand.present ? lostAt_ : row.record.t;
    tick_ = row;
    ++ticks_;
    late_ += row.late ? 1 : 0;
    if (micros_.size() < kMaxTimedTicks) {
        micros_.resize(micros_.size() + 1);
        wokenLate_.resize(micros_.size());
    }
    micros_[(ticks_ - 1) % kMaxTimedTicks] = static_cast<float>(row.micros);
    wokenLate_[(ticks_ - 1) % kMaxTimedTicks] = static_cast<float>(row.wokenLate * 1e6);
    const StepRecord& r = row.record;
    if (row.driven && row.armStatus.known) {
        measured_ = Measured{r.t - row.armStatus.age, row.armStatus.posture};
    }
    trace_.push_back(sampleOf(row));
    trace_.back().fade = fadeReason();
    const TraceWrench felt = trace_.back().delivered();
    ripple_.add(r.t, r.frame, {dvec3(felt.force), dvec3(felt.torque)});
    force_.add(r.t, glm::length(felt.force), kSpan);
    torque_.add(r.t, glm::length(felt.torque), kSpan);
    while (r.t - trace_.front().t > kSpan) {
        trace_.pop_front();
    }
    noteDelay(r);
    noteBlocks(row);
}

FadeReason RunView::fadeReason() const {
    const StepRecord& record = tick_.record;
    const bool fading = record.state == StepState::Fading;
    // An old frame stops a real arm, which then holds the forces off also when they have ramped out.
    if (isOld(record.sceneAge) && (fading || (tick_.driven && record.frame >= 0))) {
        return FadeReason::OldFrame;
    }
    if ((tick_.hand.buttons & kDeadManOpen) != 0) {
        return FadeReason::SwitchedOff;
    }
    if (tick_.driven && tick_.armStatus.state != ArmState::Follows) {
        return FadeReason::ArmStill;
    }
    if (!tick_.hand.present) {
        return FadeReason::DeviceLost;
    }
    if (fading && regionsVanished()) {
        return FadeReason::RegionGone;
    }
    return deviceWasLost() ? FadeReason::DeviceWasLost : FadeReason::Unknown;
}

void RunView::noteDelay(const StepRecord& r) {
    constexpr double kSpanOfDelays = 1.0; // [s]
    if (r.frame > usedFrame_ && std::isfinite(r.sceneAge)) {
        delays_.emplace_back(r.t, r.sceneAge);
    }
    usedFrame_ = r.frame;
    while (!delays_.empty() && r.t - delays_.front().first > kSpanOfDelays) {
        delays_.pop_front();
    }
}

FrameDelay RunView::delay() const {
    if (delays_.empty()) {
        return {};
    }
    std::vector<double> ages;
    for (const auto& [t, age] : delays_) {
        ages.push_back(age);
    }
    std::sort(ages.begin(), ages.end());
    return {ages[ages.size() / 2], ages.back()};
}

void RunView::noteBlocks(const TickRow& row) {
    const StepRecord& r = row.record;
    for (uint32_t i = 0; i < r.touchCount; ++i) {
        const Touch& touch = r.touches[i];
        auto same = std::find_if(blocks_.begin(), blocks_.end(), [&](const Block& b) {
            return b.touch.kind == touch.kind && b.touch.fixture == touch.fixture &&
                   b.touch.leaf == touch.leaf && r.t - b.last < kSameBlock;
        });
        if (same == blocks_.end()) {
            blocks_.push_front({touch, r.frame, r.t, r.t});
            same = blocks_.begin();
        }
        same->touch = touch;
        same->last = r.t;
        same->beyond = std::max(0.0, glm::dot(r.tool.position - r.device.position, touch.normal));
        same->deepest = std::max(same->deepest, same->beyond);
        same->force = glm::length(r.wrench.force);
    }
    while (blocks_.size() > kMaxBlocks) {
        blocks_.pop_back();
    }
}

Rates RunView::rates() const {
    Rates rates;
    if (trace_.size() < 2) {
        return rates;
    }
    const double now = trace_.back().t;
    size_t count = 0;
    double worst = 0.0, later = now;
    for (auto it = trace_.rbegin(); it != trace_.rend() && now - it->t <= 1.0; ++it) {
        worst = std::max(worst, later - it->t);
        later = it->t;
        ++count;
    }
    rates.hapticHz = now > later ? static_cast<double>(count - 1) / (now - later) : 0.0;
    rates.worstPeriodMs = worst * 1e3;
    if (captures_.size() > 1 && captures_.back() > captures_.front()) {
        rates.cameraHz = static_cast<double>(captures_.size() - 1) / (captures_.back() - captures_.front());
    }
    return rates;
}

} // namespace fathom::operate
