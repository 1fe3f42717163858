// SPDX-License-Identifier: Apache-2.0
#include "apps/binding/haptic_loop.h"

#include <algorithm>
#include <cmath>

namespace fathom {

namespace {

constexpr double kArmSilence = 0.1; // [s]

} // namespace

HapticLoop::HapticLoop(HapticCycle& cycle, HapticDevice& hand, Crossings& crossings, const RunClock& clock,
                       const Ends& ends, CadenceTrace* trace)
    : cycle_(cycle)
    , hand_(hand)
    , crossings_(crossings)
    , clock_(clock)
    , ends_(ends)
    , trace_(trace)
    , period_(cycle.options().period) {}

bool HapticLoop::Until::passed(const void* context) noexcept {
    const auto* until = static_cast<const Until*>(context);
    return until->clock->now() >= until->t;
}

bool HapticLoop::ended(double t) const noexcept {
    const SceneUpdate& news = crossings_.scene.front();
    const bool frames =
        news.live || news.gone || (news.sourceEnded && t >= news.captureTime + ends_.framePeriod);
    return frames && t >= ends_.pathDuration;
}

void HapticLoop::run(const std::atomic<bool>& stop) noexcept {
    uint64_t slot = 0;
    while (!stop.load(std::memory_order_relaxed)) {
        const double due = static_cast<double>(slot) * period_;
        clock_.sleepUntil(due);
        const double woken = clock_.now();
        if (ended(woken)) {
            break;
        }
        const double over = step(due);
        // One turn a period at most, however late this one was.
        const auto ran = static_cast<uint64_t>(std::max(0.0, woken / period_));
        const auto now = static_cast<uint64_t>(std::max(0.0, over / period_));
        const uint64_t next = std::max(std::max(ran, slot) + 1, now);
        missedNow_ = static_cast<uint32_t>(next - slot - 1);
        missed_ += missedNow_;
        slot = next;
    }
    hand_.write(Wrench{}, period_);
    tellArm({}, true);
    crossings_.hapticDone.store(true, std::memory_order_release);
}

// A newer answer takes the place of one that was not adopted; the old lease goes first.
void HapticLoop::offerNewest() noexcept {
    offered_ = {};
    offered_ = crossings_.contacts.newest();
    if (offered_ && inForce_ && offered_->query == inForce_->query) {
        offered_ = {};
    }
}

// Of a real arm, where one follows: what it told last. A thread of its own that has stopped is a silent arm.
void HapticLoop::hearArm(TickRow& row) noexcept {
    if (crossings_.arm == nullptr) {
        return;
    }
    crossings_.arm->told.refresh();
    row.driven = true;
    row.told = crossings_.arm->told.front();
    if (clock_.now() - clock_.at(row.told.at) > kArmSilence) {
        row.told.state = ArmState::Silent;
        row.told.known = false;
    }
    row.placed = cycle_.follow({!isFault(row.told.state), row.told.known, row.told.posture});
}

void HapticLoop::tellArm(const StepRecord& record, bool off) noexcept {
    if (crossings_.arm != nullptr) {
        crossings_.arm->setpoint.back() = {record.arm.posture, record.armHold, off,
                                           clock_.timeAt(clock_.now())};
        crossings_.arm->setpoint.publish();
    }
}

StepInput HapticLoop::inputFor(double now, const HandSample& sample, const Until& until) const noexcept {
    const SceneUpdate& news = crossings_.scene.front();
    StepInput input;
    input.time = now;
    input.deviceThandle = sample.deviceThandle;
    input.buttons = sample.buttons;
    input.contacts = inForce_ ? &*inForce_ : nullptr;
    input.offered = offered_ ? &*offered_ : nullptr;
    input.frame = news.frame;
    input.generation = news.generation;
    input.captureTime = news.captureTime;
    input.guidance = {news.guidance.data(), news.guidanceCount};
    input.sourceEnded = news.sourceEnded;
    input.measuredPeriod = first_ ? 0.0 : now - before_;
    input.deadline = {&Until::passed, &until};
    return input;
}

double HapticLoop::step(double due) noexcept {
    crossings_.scene.refresh();
    if (crossings_.shapes.refresh()) {
        const ShapeList& list = crossings_.shapes.front();
        cycle_.setShapes({list.shapes.data(), list.count});
    }
    offerNewest();
    const double began = clock_.now();
    const HandSample sample = hand_.read(std::max(0.0, began));
    // The end of the period that the clock is in: after a late wake-up that is not the one that was due.
    const Until until{&clock_, (std::floor(began / period_) + 1.0) * period_};
    const StepInput input = inputFor(began, sample, until);
    TickRow row;
    hearArm(row);
    const ToolState start = cycle_.place();
    const auto turnBegan = std::chrono::steady_clock::now();
    const StepRecord record = cycle_.step(input);
    const auto turnOver = std::chrono::steady_clock::now();
    hand_.write(record.deviceWrench, input.measuredPeriod > 0.0 ? input.measuredPeriod : period_);
    tellArm(record, (sample.buttons & kDeadManOpen) != 0);
    if (record.adopted) {
        inForce_ = std::move(offered_);
        offered_ = {};
    }
    crossings_.proxy.back() = cycle_.place();
    crossings_.proxy.publish();
    const double over = clock_.now();
    if (cycle_.onArm()) {
        crossings_.postures.add(clock_.timeAt(over), record.arm.posture);
    }
    report(record, sample, start, due, began,
           std::chrono::duration<double, std::micro>(turnOver - turnBegan).count(), over, row);
    if (trace_ != nullptr) {
        trace_->step(turnBegan, turnOver, began - due);
    }
    before_ = began;
    first_ = false;
    return over;
}

void HapticLoop::report(const StepRecord& record, const HandSample& hand, const ToolState& start, double due,
                        double began, double took, double over, TickRow& row) noexcept {
    row.record = record;
    row.hand = hand;
    row.start = start.pose;
    row.startArm = start.arm;
    row.generation = inForce_ ? inForce_->generation : 0;
    row.query = inForce_ ? inForce_->query : 0;
    row.wokenLate = began - due;
    row.micros = took;
    row.late = over > due + period_;
    row.missed = missedNow_;
    crossings_.ticks.push(row);
}

} // namespace fathom
