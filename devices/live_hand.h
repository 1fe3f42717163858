// SPDX-License-Identifier: Apache-2.0
// A haptic or hand-held device that is really there, as the apps bind it.
#pragma once

#include "devices/haptic_device.h"

#include <cstdint>
#include <string>

namespace fathom {

// Counts since the start.
struct LiveHandFigures {
    uint64_t samples = 0;  // taken from the device
    uint64_t losses = 0;   // times that it fell silent or went away
    uint64_t unsent = 0;   // wrenches that the device's queue had no room for
    double worstAge = 0.0; // [s] of the sample that a turn used while the device was there
};

// While the device is away or silent, read() gives the last pose with dead-man open and clutch down: forces
// ramp out, the tool stays, and when the device is back the tool goes on from where it is. write() then sends
// nothing but zero.
class LiveHand : public HapticDevice {
public:
    virtual std::string description() const = 0; // one line for people
    virtual std::string preset() const = 0;      // name in engine/haptics/device_preset.h
    virtual bool alive() const noexcept = 0;     // as of the last read()
    virtual LiveHandFigures figures() const noexcept = 0;
};

} // namespace fathom
