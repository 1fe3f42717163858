// SPDX-License-Identifier: Apache-2.0
#include "engine/front/hand_port.h"

#include "engine/front/float_mode.h"

#include <algorithm>
#include <chrono>

namespace fathom::v0 {

HandPort::Impl::Impl(std::shared_ptr<front::PortState> from, const HandStart& start)
    : shared(std::move(from))
    , cycle(shared->haptic.cycle(start))
    , stepper(*cycle, shared->channels, shared->clock) {
    stepper.begin();
    shared->channels.queryAt.back() = {cycle->place()};
    shared->channels.queryAt.publish(); // the contact thread begins
}

HandPort::Impl::~Impl() {
    stepper.releaseArm(shared->clock.now()); // a real arm stands still
}

Step HandPort::Impl::step(const Hand& hand, Nanoseconds now) noexcept {
    const front::FloatMode mode;
    const Nanoseconds clock = v0::now();
    const bool back = now < last;
    const bool other = now > clock + front::kMaxAhead || now < clock - front::kMaxLate;
    last = std::max(other ? clock : now, last);
    const double t = shared->clock.at(RunClock::Time(std::chrono::nanoseconds(last)));
    const bool ended = shared->ended.load();
    HandSample sample = front::internal(hand);
    sample.buttons |= ended ? kDeadManOpen : 0; // placed shapes do not age
    constexpr double kShare = 0.8; // the caller ticks at any phase of the clock, and needs some of the period
    const StepRecord& record = stepper.step(sample, t, t + kShare * stepper.period());
    Step step = front::external(record);
    // Contacts of the first set may come before what the frame thread says about it.
    const bool none = shared->haptic.scene.hasPoints() && stepper.scene().frame < 0 && record.frame < 0;
    const bool armStill = stepper.row().driven && isFault(stepper.row().armStatus.state);
    step.warnings = step.warnings | front::when(none, StepWarning::NoScene) |
                    front::when(stepper.scene().gone, StepWarning::ComputeDeviceLost) |
                    front::when(back, StepWarning::TimeBack) | front::when(ended, StepWarning::EngineFailed) |
                    front::when(other, StepWarning::OtherClock) |
                    front::when(armStill, StepWarning::ArmStill);
    shared->steps.back() = {step, hand, last};
    shared->steps.publish();
    return step;
}

HandPort::HandPort(std::unique_ptr<Impl> impl) noexcept
    : impl_(std::move(impl)) {}
HandPort::HandPort(HandPort&&) noexcept = default;
HandPort& HandPort::operator=(HandPort&&) noexcept = default;
HandPort::~HandPort() = default;

Step HandPort::step(const Hand& hand, Nanoseconds now) noexcept {
    return impl_->step(hand, now);
}

double HandPort::period() const noexcept {
    return impl_->stepper.period();
}

} // namespace fathom::v0
