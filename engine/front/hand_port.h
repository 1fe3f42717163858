// SPDX-License-Identifier: Apache-2.0
// The port of the hand.
#pragma once

#include "engine/front/port_state.h"
#include "engine/run/haptic_stepper.h"

#include <memory>

namespace fathom::v0 {

// Haptic thread only.
struct HandPort::Impl {
    Impl(std::shared_ptr<front::PortState> from, const HandStart& start);
    ~Impl();
    Step step(const Hand& hand, Nanoseconds now) noexcept;

    std::shared_ptr<front::PortState> shared;
    std::unique_ptr<HapticCycle> cycle;
    HapticStepper stepper;
    Nanoseconds last = 0;
};

} // namespace fathom::v0
