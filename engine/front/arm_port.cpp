// SPDX-License-Identifier: Apache-2.0
#include "engine/front/arm_port.h"

#include "engine/types/clock.h"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace fathom::v0 {

namespace {

PostureTrack::Time timeOf(Nanoseconds stamp) {
    return PostureTrack::Time(std::chrono::nanoseconds(stamp));
}

} // namespace

ReportStatus ArmPort::Impl::report(const MeasuredArm& arm) noexcept {
    if (arm.stamp <= 0) {
        return ReportStatus::MissingStamp;
    }
    if (arm.stamp > now() + front::kMaxAhead) {
        return ReportStatus::StampAhead;
    }
    if (arm.stamp <= last) {
        return ReportStatus::StampBack;
    }
    if (!std::ranges::all_of(arm.posture.joints, [](double q) { return std::isfinite(q); })) {
        return ReportStatus::BadPosture;
    }
    last = arm.stamp;
    const fathom::ArmPosture posture = front::internal(arm.posture);
    fathom::ArmStatus status;
    status.state = arm.ready ? ArmState::Follows : ArmState::Behind;
    status.known = true;
    status.posture = posture;
    status.age = 0.0;
    status.at = timeOf(arm.stamp);
    shared->arm.status.back() = status;
    shared->arm.status.publish();
    shared->arm.setpoint.refresh();
    shared->arm.addMeasured(status.at, posture);
    return ReportStatus::Accepted;
}

ArmSetpoint ArmPort::Impl::setpoint() noexcept {
    shared->arm.setpoint.refresh();
    const fathom::ArmSetpoint& newest = shared->arm.setpoint.front();
    ArmSetpoint out;
    out.posture = front::external(newest.posture);
    out.stamp = std::max<Nanoseconds>(nanosecondsOf(newest.at), 0);
    out.hold = newest.hold || now() - out.stamp > kSetpointStale;
    out.forcesOff = newest.off;
    return out;
}

ArmPort::ArmPort(std::unique_ptr<Impl> impl) noexcept
    : impl_(std::move(impl)) {}
ArmPort::ArmPort(ArmPort&&) noexcept = default;
ArmPort& ArmPort::operator=(ArmPort&&) noexcept = default;
ArmPort::~ArmPort() = default;

ReportStatus ArmPort::report(const MeasuredArm& arm) noexcept {
    return impl_->report(arm);
}

ArmSetpoint ArmPort::setpoint() noexcept {
    return impl_->setpoint();
}

std::size_t ArmPort::joints() const noexcept {
    return impl_->shared->haptic.arm->model.count();
}

std::string ArmPort::jointName(std::size_t joint) const {
    if (joint >= joints()) {
        throw BadInput("joint: " + std::to_string(joint) + " (allowed: 0 to " + std::to_string(joints() - 1) +
                       ")");
    }
    return impl_->shared->haptic.arm->model.joints[joint].name;
}

} // namespace fathom::v0
