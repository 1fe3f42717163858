// SPDX-License-Identifier: Apache-2.0
// Simulated haptic devices: a hand that reacts to forces, and one that only follows its path.
#pragma once

#include "devices/simulated/hand_path.h"
#include "engine/scene/scene.h"
#include "engine/types/haptic_device.h"

#include <array>
#include <cstdint>

namespace fathom {

// Follows the path exactly and ignores every force.
class ScriptedHand final : public HapticDevice {
public:
    explicit ScriptedHand(HandPath path)
        : path_(std::move(path)) {}
    HandSample read(double t) noexcept override { return path_.at(t); }
    void write(const Wrench&, double) noexcept override {}

private:
    HandPath path_;
};

// Parameters of the simulated hand and its device.
struct SimulatedHandOptions {
    HandLoop loop;
    double armLength = 0.05; // [m] k: inertia, rotational damping and stiffness are the linear ones times k^2
    double encoderStep = 0.0; // [m] a position reading is rounded to; 0 = exact
    double encoderAngle =
        0.0;                 // [rad] each component of the reading's rotation vector is rounded to; 0 = exact
    uint32_t delayTicks = 0; // writes until a wrench reaches the hand, 0..64
};

// A hand that holds the handle: per axis m a = K (path - x) - D v + F, with damping against the ground so
// that it can only take energy out, and the same about the handle's centre with J = m k^2. Drift-kick-drift
// in at least 4 substeps a write: exact for a constant wrench. Starts at rest at the path's first pose.
class SimulatedHand final : public HapticDevice {
public:
    // Throws Error unless mass > 0, stiffness >= 0, damping >= 0, k > 0, steps >= 0, delay <= 64, all finite.
    SimulatedHand(HandPath path, SimulatedHandOptions options);

    // The handle as it is now, by its encoders; buttons of the path at t. Keeps t for the next write.
    HandSample read(double t) noexcept override;
    // Moves the hand on by dt [s] under the wrench (device axes) written delayTicks writes ago. A wrench that
    // is not finite counts as zero. A dt that is not positive does nothing.
    void write(const Wrench& deviceWrench, double dt) noexcept override;

    const Pose& handle() const { return handle_; }      // exact, without encoders
    const dvec3& velocity() const { return velocity_; } // [m/s]
    const dvec3& spin() const { return spin_; }         // [rad/s] device axes
    // Kinetic energy and that of the spring to the path at t [J].
    double energy(double t) const noexcept;

    static constexpr uint32_t kMaxDelay = 64;

private:
    void substep(const Wrench& wrench, double t, double h) noexcept;

    HandPath path_;
    SimulatedHandOptions options_;
    Pose handle_;
    dvec3 velocity_{0.0};
    dvec3 spin_{0.0};
    double now_ = 0.0;
    std::array<Wrench, kMaxDelay + 1> pending_{};
    uint32_t written_ = 0;
};

} // namespace fathom
