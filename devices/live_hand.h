// SPDX-License-Identifier: Apache-2.0
// A physical haptic or hand-held device.
#pragma once

#include "engine/types/haptic_device.h"

#include <cstdint>
#include <string>

namespace fathom {

// Counters since the start.
struct LiveHandFigures {
    uint64_t samples = 0;  // received from the device
    uint64_t losses = 0;   // number of silences and disconnects
    uint64_t unsent = 0;   // wrenches dropped because the device's queue was full
    double worstAge = 0.0; // [s] oldest sample used in a tick while the device was present
};

// While the device is absent or silent, read() returns the last pose with the dead-man switch open and the
// clutch down: forces ramp out, the tool stays, and the tool resumes from there when the device is back.
// write() sends only zero meanwhile.
class LiveHand : public HapticDevice {
public:
    virtual std::string description() const = 0; // one line for display
    virtual std::string preset() const = 0;      // name in engine/haptics/device_preset.h
    virtual bool alive() const noexcept = 0;     // as of the last read()
    virtual LiveHandFigures figures() const noexcept = 0;
};

} // namespace fathom
