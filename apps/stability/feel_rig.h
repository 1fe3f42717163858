// SPDX-License-Identifier: Apache-2.0
// A hand at the surface of an analytic scene that a camera sees with fresh noise in every frame. The regions
// are made by the float64 twins; the true surface is known, so paths are given by depth below it.
#pragma once

#include "apps/stability/image_fixtures.h"
#include "apps/stability/lockstep_rig.h"
#include "apps/verify/felt_trace.h"
#include "devices/simulated/simulated_camera.h"
#include "devices/simulated/simulated_hand.h"

#include <string>

namespace fathom::stability {

struct FeelSpec {
    std::string scene = "torus";  // of analytic_scene.h, or "wall": flat, across the axis
    bool noise = true;            // of the camera, drawn anew for every frame
    double focal = 350.0;         // [pixels] of the camera: 2 mm per pixel at 0.7 m
    double errorBudget = 0.0001;  // [m]
    Scene::Haptics haptics;       // friction, margin, damping, smooth and stiffness of the case
    std::optional<HandLoop> loop; // a hand that yields; empty = one that follows its path exactly
    bool ball = false;            // the tool: a ball of 10 mm, else a gripper of eight spheres
};

// One run at 1 kHz and 30 frames per second. For one thread; allocates.
class FeelRig {
public:
    static constexpr double kRegion = 0.04; // [m] radius of the regions

    explicit FeelRig(const FeelSpec& spec);

    // base_T_tool whose tool is `depth` [m] below the resting place on the true surface along the optical
    // axis through x, y [m]; negative: in front of it.
    Pose at(double x, double y, double depth, const dvec3& rotation = dvec3(0.0)) const;
    // The red ring of scene "torus", by angle [rad].
    Pose onRing(double angle, double depth) const;

    // Starts a path [s since now]. The first pose of a rig's first path is where the tool starts.
    void follow(std::vector<HandWaypoint> path);
    // Runs and records.
    void run(double seconds);
    void forget() { trace_.clear(); }

    const FeltTrace& trace() const { return trace_; }
    const LockstepRig& rig() const { return *rig_; }
    const StepRecord& last() const { return record_; }
    const HapticOptions& options() const { return options_; }
    double period() const { return options_.period; }

private:
    void look();
    SimulatedCamera cameraOf(bool noise) const;
    HostFixtures wallFrame(ImageFixtures& make, bool noise);
    double restingPlace(double x, double y, const dquat& rotation) const;

    FeelSpec spec_;
    Scene scene_;
    Tool tool_;
    HapticOptions options_;
    SimulatedCamera camera_;
    Rng rng_{17};
    uint64_t frames_ = 0;
    HostFixtures truth_;
    ImageFixtures make_;
    std::optional<HostFixtures> still_; // the newest frame; without noise all are the same
    std::unique_ptr<LockstepRig> rig_;
    std::unique_ptr<HapticDevice> hand_;
    FeltTrace trace_;
    StepRecord record_;
    uint64_t ticks_ = 0;
    double started_ = 0.0; // [s] of the path
};

} // namespace fathom::stability
