// SPDX-License-Identifier: Apache-2.0
// The bridge's last word on force: passes the engine's newest wrench while it keeps coming, else zero.
#pragma once

#include "devices/bridge/fathom_door.h"
#include "engine/types/wrench.h"

#include <cstdint>

namespace fathom {

// Pure state and arithmetic; the caller brings the clock [ns]. noexcept, no allocation, one thread.
class ForceGate {
public:
    // forceLimit [N], torqueLimit [N m]: each vector is shortened to it, its direction stays.
    ForceGate(double forceLimit, double torqueLimit) noexcept
        : forceLimit_(forceLimit)
        , torqueLimit_(torqueLimit) {}

    // A wrench that was computed at `stamp`, not later than now; an older one than the newest is left out.
    // One that is not finite closes the gate and is counted.
    void accept(const Wrench& wrench, uint64_t stamp) noexcept;
    // The engine's end is closed or says that it is about to.
    void close() noexcept;

    // What the device may render now: zero when closed or when the newest is older than 10 ms; coming back
    // from that it rises over kRamp.
    Wrench at(uint64_t now) const noexcept;
    bool silent(uint64_t now) const noexcept { return !open_ || now - newest_ > kSilence; }
    uint64_t silences() const noexcept { return silences_; } // gaps over 10 ms between two wrenches
    uint64_t notFinite() const noexcept { return notFinite_; }

    static constexpr uint64_t kSilence = FATHOM_DOOR_SILENCE_NS;
    static constexpr uint64_t kRamp = 100000000; // [ns]

private:
    double forceLimit_, torqueLimit_;
    Wrench wrench_;
    bool open_ = false;
    uint64_t newest_ = 0, since_ = 0; // stamps: of the newest, of the first one after the last silence
    uint64_t silences_ = 0, notFinite_ = 0;
};

} // namespace fathom
