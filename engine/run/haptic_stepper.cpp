// SPDX-License-Identifier: Apache-2.0
#include "engine/run/haptic_stepper.h"

#include "engine/types/clock.h"

namespace fathom {

namespace {

constexpr double kArmSilence = 0.1; // [s] without a status: the arm's thread has stopped

} // namespace

bool HapticStepper::Until::passed(const void* context) noexcept {
    const auto* until = static_cast<const Until*>(context);
    return until->clock->now() >= until->t;
}

void HapticStepper::takeNewest() noexcept {
    channels_.scene.refresh();
    if (channels_.shapes.refresh()) {
        const ShapeList& list = channels_.shapes.front();
        cycle_.setShapes({list.shapes.data(), list.count});
    }
    contacts_.offer([this]() noexcept { return channels_.contacts.newest(); });
}

void HapticStepper::followArm(double now) noexcept {
    row_.driven = channels_.arm != nullptr;
    row_.placed = false;
    if (channels_.arm == nullptr) {
        return;
    }
    channels_.arm->status.refresh();
    row_.armStatus = channels_.arm->status.front();
    if (now - clock_.at(row_.armStatus.at) > kArmSilence) {
        row_.armStatus.state = ArmState::Silent;
        row_.armStatus.known = false;
    }
    row_.placed =
        cycle_.follow({!isFault(row_.armStatus.state), row_.armStatus.known, row_.armStatus.posture});
}

void HapticStepper::sendSetpoint(const StepRecord& record, bool off, double now) noexcept {
    if (channels_.arm != nullptr) {
        channels_.arm->setpoint.back() = {record.arm.posture, record.armHold, off, clock_.timeAt(now)};
        channels_.arm->setpoint.publish();
    }
}

const StepRecord& HapticStepper::step(const HandSample& hand, double now, double end) noexcept {
    takeNewest();
    StepInput input = stepInput(channels_.scene.front(), hand, now);
    sinceLast_ = first_ ? 0.0 : now - before_;
    input.measuredPeriod = sinceLast_;
    check_.judge(input);
    const Until until{&clock_, end};
    input.deadline = {&Until::passed, &until};
    followArm(now);
    row_.start = cycle_.place();
    began_ = Clock::now();
    row_.record = contacts_.step(cycle_, input);
    channels_.clearance.refresh();
    row_.record.clearance = channels_.clearance.front();
    ended_ = Clock::now();
    publish(hand, now);
    before_ = now;
    first_ = false;
    return row_.record;
}

void HapticStepper::publish(const HandSample& hand, double now) noexcept {
    row_.hand = hand;
    const ContactSet* active = contacts_.active();
    row_.generation = active != nullptr ? active->generation : 0;
    row_.query = active != nullptr ? active->query : 0;
    row_.micros = micros(began_, ended_);
    sendSetpoint(row_.record, (hand.buttons & kDeadManOpen) != 0, now);
    channels_.queryAt.back() = cycle_.queryPlace();
    channels_.queryAt.publish();
    channels_.clearanceAt.back() = cycle_.place();
    channels_.clearanceAt.publish();
    if (cycle_.onArm()) {
        channels_.postures.add(ended_, row_.record.arm.posture);
    }
}

void HapticStepper::log(const Timing& timing) noexcept {
    row_.wokenLate = timing.wokenLate;
    row_.late = timing.late;
    row_.missed = timing.missed;
    channels_.ticks.push(row_);
}

} // namespace fathom
