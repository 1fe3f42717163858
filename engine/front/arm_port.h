// SPDX-License-Identifier: Apache-2.0
// The arm thread's end of the mailboxes between a real arm and the haptic thread.
#pragma once

#include "engine/front/port_state.h"

namespace fathom::v0 {

// Arm thread only.
struct ArmPort::Impl {
    explicit Impl(std::shared_ptr<front::PortState> from)
        : shared(std::move(from)) {}
    ReportStatus report(const MeasuredArm& arm) noexcept;
    ArmSetpoint setpoint() noexcept;

    std::shared_ptr<front::PortState> shared;
    Nanoseconds last = 0; // stamp of the newest report

    static constexpr Nanoseconds kSetpointStale = 100'000'000; // [ns] an older setpoint holds the arm
};

} // namespace fathom::v0
