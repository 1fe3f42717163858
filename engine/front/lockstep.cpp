// SPDX-License-Identifier: Apache-2.0
#include "engine/front/camera_port.h"
#include "engine/front/core.h"
#include "engine/front/float_mode.h"
#include "engine/front/observer_port.h"
#include "engine/run/clearance.h"
#include "engine/run/delayed_contacts.h"
#include "engine/run/scene_update.h"

#include <algorithm>
#include <chrono>
#include <limits>

namespace fathom::v0 {

struct Lockstep::Impl {
    Impl(const Scene& scene, const CameraModel& model, const HandStart& start, const EngineOptions& options)
        : camera(front::CameraSetup(model, scene.data().scene))
        , haptic(scene.data().scene, camera.info, options)
        , compute(haptic, camera.info, options.computeDevice)
        , cycle(haptic.cycle(start))
        , clearance(haptic.options.period) {
        if (options.measuredArm) {
            throw BadInput("options: measuredArm: true (allowed: false in lockstep)");
        }
    }

    FrameTimes process(const Frame& frame);
    bool queryContacts();

    const pid_t processId = ::getpid();
    CameraPort::Impl camera;
    front::HapticSetup haptic;
    front::ComputeState compute;
    std::unique_ptr<HapticCycle> cycle;
    DelayedContacts contacts;
    SceneUpdate update;
    Nanoseconds stamp = 0;                                      // of the newest frame
    Nanoseconds last = std::numeric_limits<Nanoseconds>::min(); // time of the last step
    SteppedClearance clearance;
};

namespace {

double seconds(Nanoseconds time) {
    return static_cast<double>(time) / 1e9;
}

FrameTimes frameTimes(const FrameReport& report) {
    const std::chrono::duration<double> device = report.times.completed - report.times.submitted;
    return {report.uploadMs / 1e3, report.unchanged ? 0.0 : device.count(), report.latencyMs / 1e3};
}

} // namespace

FrameTimes Lockstep::Impl::process(const Frame& frame) {
    fathom::Frame taken = camera.copy(frame);
    const double t = seconds(frame.stamp);
    taken.retime(t);
    compute.setArm(cycle->place().arm);
    const FrameReport report = compute.process(std::move(taken));
    update.captureTime = t;
    if (const auto set = compute.cycles.frames().sets().newest(); set && !report.unchanged) {
        update.show(set->host);
    }
    stamp = frame.stamp;
    return frameTimes(report);
}

bool Lockstep::Impl::queryContacts() {
    auto set = std::make_unique<ContactSet>();
    const bool any = compute.cycles.answer(cycle->queryPlace(), *set);
    if (any) {
        contacts.push(std::move(set));
        clearance.update([this] { return compute.cycles.clearance(cycle->place()); });
    }
    contacts.offerDue(haptic.scene.contact.delay);
    return any;
}

Lockstep::Lockstep(const Scene& scene, const CameraModel& camera, const HandStart& start,
                   const EngineOptions& options)
    : impl_(front::translated([&] {
        const front::FloatMode mode;
        return std::make_unique<Impl>(scene, camera, start, options);
    })) {}

Lockstep::~Lockstep() {
    front::leakInForkedChild(impl_->processId, impl_);
}

FrameTimes Lockstep::process(const Frame& frame) {
    return front::translated([&] {
        const front::FloatMode mode;
        return impl_->process(frame);
    });
}

bool Lockstep::regions(Regions& out) const {
    const auto set = impl_->compute.cycles.frames().sets().newest();
    if (set) {
        front::fill(out, set->host);
        out.stamp = impl_->stamp;
    }
    return static_cast<bool>(set);
}

bool Lockstep::queryContacts() {
    return front::translated([&] {
        const front::FloatMode mode;
        return impl_->queryContacts();
    });
}

Step Lockstep::step(const Hand& hand, Nanoseconds now) noexcept {
    const front::FloatMode mode;
    const bool back = now < impl_->last;
    impl_->last = std::max(now, impl_->last);
    const StepInput input = stepInput(impl_->update, front::internal(hand), seconds(impl_->last));
    StepRecord record = impl_->contacts.step(*impl_->cycle, input);
    record.clearance = impl_->clearance.gap();
    Step step = front::external(record);
    const bool none = impl_->haptic.scene.hasPoints() && impl_->update.frame < 0;
    step.warnings =
        step.warnings | front::when(none, StepWarning::NoScene) | front::when(back, StepWarning::TimeBack);
    return step;
}

void Lockstep::clearances(std::span<const Pose> baseTtool, Clearances& out) {
    front::translated([&] {
        const front::FloatMode mode;
        const double t = impl_->compute.clearances(baseTtool, out);
        out.stamp = out.frame < 0 ? 0 : std::llround(t * 1e9);
    });
}

void Lockstep::endFrames() noexcept {
    impl_->update.sourceEnded = true;
}

double Lockstep::period() const noexcept {
    return impl_->haptic.options.period;
}

} // namespace fathom::v0
