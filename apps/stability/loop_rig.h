// SPDX-License-Identifier: Apache-2.0
// The closed loop in lockstep: a device with a hand on it, the haptic cycle, and the fixtures that it meets;
// with an account of the energy that passes between them.
#pragma once

#include "devices/simulated/simulated_hand.h"
#include "engine/contact/cull_cpu.h"
#include "engine/run/active_contacts.h"

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace fathom::stability {

// What the hand adds to the device: mass [kg], damping [N s/m], spring to where it wants to be [N/m].
struct HandModel {
    const char* name;
    double mass, damping, stiffness;
};
// Nobody holds it; two fingers; a loose, a normal and a firm grip. Figures of the order that is published for
// hands and wrists (0.05-1 kg, 1-15 N s/m, 50-1000 N/m).
inline constexpr std::array<HandModel, 5> kHands{{{"free", 0.0, 0.0, 0.0},
                                                  {"fingers", 0.05, 1.0, 50.0},
                                                  {"loose grip", 0.15, 2.5, 150.0},
                                                  {"grip", 0.4, 6.0, 400.0},
                                                  {"firm grip", 1.0, 15.0, 1000.0}}};

struct LoopSpec {
    double mass = 0.1, damping = 0.5; // of the device [kg], [N s/m]; b of the preset
    HandModel hand = kHands[0];
    double rateHz = 1000.0;
    uint32_t delay = 0;        // ticks from write to hand
    double encoderStep = 0.0;  // [m]
    double encoderAngle = 0.0; // [rad]
    double armLength =
        0.1; // [m] inertia, rotational damping and stiffness are the linear ones times its square
    std::optional<double> stiffness;           // [N/m]; empty = automatic
    std::optional<double> rotationalStiffness; // [N m/rad]
    double virtualDamping = 0.0;               // B [N s/m]
    double lowPassHz = 0.0;
    bool controller = true; // passivity
    bool limited = true;    // 20 N, 2 N m and the slew limits; false: none, the loop is linear
    std::vector<Sphere> leaves{{dvec3(0.0), 0.01}};
    std::vector<Shape> shapes;
    std::optional<Fixtures> fixtures;   // points; swapped by LoopRig::show
    std::vector<GuidancePose> guidance; // pulls while the path's button is down
    std::vector<HandWaypoint> path;     // where the hand wants to be; the device starts at its first pose

    double period() const { return 1.0 / rateHz; }
    double wholeMass() const { return mass + hand.mass; }
    double wholeDamping() const { return damping + hand.damping; }
};

// Device preset, springs and limits of a spec: b and b_r = b armLength^2 are known, the stiffness is the
// passive bound unless given.
HapticOptions loopOptions(const LoopSpec& spec, const Tool& tool);

// One run. Throws Error when the spec makes no sense.
class LoopRig {
public:
    explicit LoopRig(const LoopSpec& spec);

    const StepRecord& tick();
    void run(double seconds);
    void show(Fixtures fixtures); // a new frame
    // Turns take this long [s] from now on and the cycle is told so; 0 = as planned.
    void setMeasuredPeriod(double period) { measured_ = period; }

    const SimulatedHand& hand() const { return hand_; }
    HapticCycle& cycle() { return *cycle_; }
    const HapticOptions& options() const { return options_; }
    double time() const { return time_; }
    const StepRecord& last() const { return record_; }

    // Since the start, at the hand [J]: what the wrench did on it, exactly (it is constant over a turn), and
    // at least what the device's own damping took.
    double energyOut() const { return energyOut_; }
    double dissipated() const { return dissipated_; }
    double netEnergyOut() const { return energyOut_ - dissipated_; }
    double path() const {
        return pathLength_;
    } // [m] that the hand travelled, turns weighed by the arm length

private:
    void account(const Wrench& felt, const Pose& before, double period);

    LoopSpec spec_;
    Tool tool_;
    HapticOptions options_;
    SimulatedHand hand_;
    std::unique_ptr<HapticCycle> cycle_;
    CullCpu cull_;
    RegionGrid grid_;
    std::array<ContactSet, 2> sets_; // the active one, and one for the next answer
    ActiveContacts<ContactSet*> contacts_;
    std::array<Wrench, SimulatedHand::kMaxDelay + 1> sent_{};
    uint64_t ticks_ = 0;
    double time_ = 0.0, measured_ = 0.0;
    double energyOut_ = 0.0, dissipated_ = 0.0, pathLength_ = 0.0;
    StepRecord record_;
};

// Shapes and sets that the cases share. A wall: the half-space below `height` along `normal` (unit).
Shape wallShape(const dvec3& normal, double height);
Shape lineShape(const dvec3& along); // endless line through the origin: a spring that pulls both ways
// Square patch of spheres of 40 mm, spacing 4 mm, whose tops lie at z = height.
Fixtures sphereWall(double height, uint64_t generation);

HandWaypoint wayAt(double t, const dvec3& position, const dvec3& rotation = dvec3(0.0));

} // namespace fathom::stability
