// SPDX-License-Identifier: Apache-2.0
// The interface of a haptic device, live or simulated. The engine implements none.
#pragma once

#include "engine/types/pose.h"
#include "engine/types/wrench.h"

#include <cstdint>

namespace fathom {

// Bits of HandSample::buttons.
inline constexpr uint32_t kGuidanceButton = 1; // switches guidance on
inline constexpr uint32_t kDeadManOpen = 2;    // switches forces off
inline constexpr uint32_t kDefaultClutch = 4;  // the scene may choose another bit

// One sample of the hand.
struct HandSample {
    Pose deviceThandle;   // raw, device frame: position [m], orientation
    uint32_t buttons = 0; // level-sensitive bit field
    bool present = true;  // false: the device is gone or silent, and a wrench written now is not rendered
};

// Called only by the haptic thread, once per tick: read, then write. Never allocates, locks or throws, and
// waits only for the exchange with the device.
class HapticDevice {
public:
    virtual ~HapticDevice() = default;
    virtual HandSample read(double t) noexcept = 0;                         // t [s] since the run's start
    virtual void write(const Wrench& deviceWrench, double dt) noexcept = 0; // device axes, about the handle
};

} // namespace fathom
