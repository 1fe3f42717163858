// SPDX-License-Identifier: Apache-2.0
// The closed loop in lockstep: hand, device, haptic cycle, fixtures. Accounts for the energy that passes
// between hand and fixtures.
#pragma once

#include "devices/simulated/simulated_hand.h"
#include "engine/contact/cull_cpu.h"
#include "engine/run/active_contacts.h"

#include <array>
#include <memory>
#include <optional>
#include <vector>

namespace fathom::stability {

// A hand on the device: its mass [kg], damping [N s/m] and the spring to its target [N/m].
struct HandModel {
    const char* name;
    double mass, damping, stiffness;
};
// Free device, two fingers, and a loose, a normal and a firm grip. The values span the published range for
// hands and wrists (0.05-1 kg, 1-15 N s/m, 50-1000 N/m).
inline constexpr std::array<HandModel, 5> kHands{{{"free", 0.0, 0.0, 0.0},
                                                  {"fingers", 0.05, 1.0, 50.0},
                                                  {"loose grip", 0.15, 2.5, 150.0},
                                                  {"grip", 0.4, 6.0, 400.0},
                                                  {"firm grip", 1.0, 15.0, 1000.0}}};

struct LoopSpec {
    double mass = 0.1, damping = 0.5; // of the device [kg], [N s/m]; damping is b of the preset
    HandModel hand = kHands[0];
    double rateHz = 1000.0;
    uint32_t delay = 0;        // [ticks] from writing a force to the hand
    double encoderStep = 0.0;  // [m]
    double encoderAngle = 0.0; // [rad]
    // [m] inertia, rotational damping and stiffness are the linear values times its square
    double armLength = 0.1;
    std::optional<double> stiffness;           // [N/m]; empty = automatic
    std::optional<double> rotationalStiffness; // [N m/rad]
    double virtualDamping = 0.0;               // B [N s/m]
    double lowPassHz = 0.0;
    double friction = 0.0;  // mu
    bool smooth = false;    // planes over spheres
    bool controller = true; // passivity controller
    bool limited = true;    // 20 N, 2 N m and slew limits; false: no limits, a linear loop
    std::vector<Sphere> leaves{{dvec3(0.0), 0.01}};
    std::vector<Shape> shapes;
    std::optional<HostFixtures> fixtures; // points; LoopRig::show replaces them
    std::vector<GuidancePose> guidance;   // active while the path's button is pressed
    std::vector<HandWaypoint> path;       // target poses of the hand; the device starts at the first one

    double period() const { return 1.0 / rateHz; }
    double wholeMass() const { return mass + hand.mass; }
    double wholeDamping() const { return damping + hand.damping; }
};

// Device preset, springs and limits of a spec, with b and b_r = b armLength^2. The stiffness is the passive
// bound unless the spec gives one.
HapticOptions loopOptions(const LoopSpec& spec, const Tool& tool);

// One run. The constructor throws Error for an invalid spec.
class LoopRig {
public:
    explicit LoopRig(const LoopSpec& spec);

    const StepRecord& tick();
    void run(double seconds);
    void show(HostFixtures fixtures); // a new frame
    // Sets the real tick period [s] from now on, which the cycle also receives; 0 = the nominal period.
    void setMeasuredPeriod(double period) { measured_ = period; }

    const SimulatedHand& hand() const { return hand_; }
    HapticCycle& cycle() { return *cycle_; }
    const HapticOptions& options() const { return options_; }
    double time() const { return time_; }
    const StepRecord& last() const { return record_; }

    // [J] since the start: work of the wrench at the hand, exact because the wrench is constant over a tick.
    double energyOut() const { return energyOut_; }
    // [J] the same less a lower bound of the loss in the device's own damping.
    double netEnergyOut() const { return energyOut_ - dissipated_; }
    // [m] travelled by the hand; rotations count times the arm length
    double path() const { return pathLength_; }

private:
    void account(const Wrench& felt, const Pose& before, double period);

    LoopSpec spec_;
    Tool tool_;
    HapticOptions options_;
    SimulatedHand hand_;
    std::unique_ptr<HapticCycle> cycle_;
    CullCpu cull_;
    RegionGrid grid_;
    std::array<ContactSet, 2> sets_; // the active set, and one for the next answer
    ActiveContacts<ContactSet*> contacts_;
    std::array<Wrench, SimulatedHand::kMaxDelay + 1> sent_{};
    uint64_t ticks_ = 0;
    double time_ = 0.0, measured_ = 0.0;
    double energyOut_ = 0.0, dissipated_ = 0.0, pathLength_ = 0.0;
    StepRecord record_;
};

// Shapes and sets shared by the cases. A wall is the half-space below `height` along the unit vector
// `normal`.
Shape wallShape(const dvec3& normal, double height);
Shape lineShape(const dvec3& along); // infinite line through the origin: a two-sided spring
// Square patch of spheres of 40 mm radius, spaced by 4 mm, with their tops at z = height.
HostFixtures sphereWall(double height, uint64_t generation);

HandWaypoint wayAt(double t, const dvec3& position, const dvec3& rotation = dvec3(0.0));

} // namespace fathom::stability
