// SPDX-License-Identifier: Apache-2.0
// The final force limit in the bridge: passes the engine's newest wrench while packets keep arriving, else
// zero.
#pragma once

#include "engine/include/fathom/device_socket.h"
#include "engine/types/wrench.h"

#include <cstdint>

namespace fathom {

// Pure state; the caller passes the time [ns]. noexcept, no allocation, one thread.
class ForceGate {
public:
    // forceLimit [N], torqueLimit [N m]: each vector is scaled down to its limit.
    ForceGate(double forceLimit, double torqueLimit) noexcept
        : forceLimit_(forceLimit)
        , torqueLimit_(torqueLimit) {}

    // Takes a wrench computed at `stamp` <= now; an older one than the newest is ignored. A wrench that is
    // not finite closes the gate and is counted.
    void accept(const Wrench& wrench, uint64_t stamp) noexcept;
    // The engine has closed its end or announced it.
    void close() noexcept;

    // The wrench to render now: zero when closed or when the newest is older than 10 ms; afterwards its
    // limits rise from zero over kRamp.
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
