// SPDX-License-Identifier: Apache-2.0
// How the force fades out and returns. Fading out scales the wrench. A force that returns is bounded by a
// share of the limits that grows from what the device renders at that moment, so it never jumps to what the
// spring has stored meanwhile.
#pragma once

#include <array>
#include <cstddef>

namespace fathom {

// One thread; noexcept, no allocation.
class ForceRamps {
public:
    enum Reason : size_t { SwitchedOff, Trapped, Stale };
    static constexpr size_t kReasons = Stale + 1;

    // One tick. on: per reason, whether forces are allowed. Falls take `elapsed` [s], so that late ticks
    // cannot delay them; rises take `period`. rendered: share of the limits that the device renders now.
    // riseTime [s]: from zero to the limits after the reason SwitchedOff.
    void step(const std::array<bool, kReasons>& on, double period, double elapsed, double rendered,
              double riseTime) noexcept;
    // The device renders nothing: no force until step() lets it rise from zero.
    void cut() noexcept;

    double fadeGain() const noexcept { return gain_[SwitchedOff] * gain_[Trapped] * gain_[Stale]; } // 0..1
    // 0..1: factor of the force and torque limits while a force returns.
    double limitScale() const noexcept { return limitScale_; }
    bool off() const noexcept { return gain_[SwitchedOff] == 0.0; }
    bool active() const noexcept { return fadeGain() < 1.0 || limitScale_ < 1.0; }

    static constexpr double kRampTime = 0.2; // [s] forces off, clutch, trapped, device lost
    static constexpr double kFadeTime = 0.5; // [s] old scene

private:
    std::array<double, kReasons> gain_{0.0, 1.0, 1.0};
    double limitScale_ = 0.0;
    double rise_ = kRampTime; // [s] from zero to the limits
};

} // namespace fathom
