// SPDX-License-Identifier: Apache-2.0
// Input and output of one haptic step: plain values, no owners.
#pragma once

#include "engine/contact/contact_set.h"
#include "engine/contact/host_fixtures.h"
#include "engine/haptics/proxy.h"
#include "engine/model/arm_model.h"
#include "engine/types/haptic_device.h"
#include "engine/types/pose.h"
#include "engine/types/wrench.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>

namespace fathom {

// What tool and forces do.
enum class StepState : uint8_t {
    Off,     // no contact set yet, or forces off and ramped out: the wrench is zero
    Free,    // no region or shape pushes; a joint's limit may
    Contact, // some region or shape pushes
    Escape,  // new data covers the tool, which moves out
    Trapped, // no motion obeys every row: the tool is held, the force ramps out
    Fading,  // scene too old, forces off or regions that pressed vanished, and not yet ramped out
    Waiting, // nothing pushes, and the tool lags behind the hand: no force
};

// Its name in haptics.csv.
constexpr const char* stateName(StepState state) {
    constexpr const char* kNames[] = {"off", "free", "contact", "escape", "trapped", "fading", "waiting"};
    return kNames[static_cast<size_t>(state)];
}

// Input of a step.
struct StepInput {
    double time = 0.0;    // [s] of this step, on the clock of capture times
    Pose deviceThandle;   // raw, as the device gives it
    uint32_t buttons = 0; // level-sensitive bits of haptic_device.h
    bool forcesOff = false;
    bool present = true; // false: the device is gone or silent, and renders no wrench
    // The pose is an outlier until later samples agree: hand and tool stay, the force may only fall.
    bool unconfirmed = false;
    // The pose is accepted from now on, wherever it is: the tool stays, as after a clutch.
    bool reindex = false;

    // The active set (that the previous step obeyed; null = none), and a newer one on offer. Both must
    // outlive the step. When StepRecord::adopted is true, the newer one is active from now on. A set
    // whose trust region the tool has left is not adopted: keep offering it or a newer one.
    const ContactSet* active = nullptr;
    const ContactSet* offered = nullptr;

    // The newest fixture set of the frame cadence.
    int64_t frame = -1;
    uint64_t generation = 0;
    // [s] of the newest frame that confirms the set; later than the set's own while nothing changes
    double captureTime = 0.0;
    std::span<const GuidancePose> guidance;
    bool sourceEnded = false; // lockstep: the last frame stays valid and does not age

    double measuredPeriod = 0.0; // [s] since the previous step; 0 = the nominal one
    Deadline deadline;           // realtime; none in lockstep
};

// The input of one step at `now` [s] for a sample of the hand: no scene, no contact sets.
inline StepInput stepInput(const HandSample& hand, double now) noexcept {
    StepInput input;
    input.time = now;
    input.deviceThandle = hand.deviceThandle;
    input.buttons = hand.buttons;
    input.present = hand.present;
    return input;
}

// A value that no step has measured yet.
inline constexpr double kNotKnown = std::numeric_limits<double>::quiet_NaN();

inline constexpr uint32_t kNoFixture = UINT32_MAX; // of rows of kind Behind: the visible surface pushes

// A row that pushed in the last solve of the step, for displays and logs. Base frame [m].
struct Touch {
    ContactRow::Kind kind = ContactRow::Kind::Sphere;
    dvec3 point{0.0};              // on the leaf's surface, nearest to the region
    dvec3 normal{0.0};             // unit, out of the region; zero for a row of pure rotation
    double gap = 0.0;              // [m] when the row was made
    double multiplier = 0.0;       // of the row in the solution, > 0
    uint32_t leaf = 0;             // index in the tool
    uint32_t source = 0;           // sphere: RegionSpheres::source; else the shape's index
    uint32_t fixture = kNoFixture; // index into Scene::fixtures
};
inline constexpr size_t kMaxTouches = 8;

// Pose of the tool, and posture of its arm if it has one.
struct ToolPlace {
    Pose pose; // base_T_tool
    ArmPosture arm;
};

// What a contact query is asked for.
struct QueryPlace {
    ToolPlace place;            // where the tool is, or will be when the answer is used
    double askedAt = kNotKnown; // [s] of the step that asks; NaN: before any
    double extraReach = 0.0;    // [m] beyond the scene's reach, for late answers and pressed arms
};

// Status of the real arm that follows the tool's arm, before a step.
struct ArmFollow {
    bool follows = false; // false: the arm stands still
    bool known = false;   // `posture` was measured recently
    ArmPosture posture;
};

// Result of a step for an arm; all zero without an arm.
struct ArmRecord {
    ArmPosture posture;                 // after the step
    double residual = 0.0;              // [m] distance to the target in the metric M
    double smallestSingularValue = 0.0; // [m/rad] of M^1/2 J; 0 = singular
    uint32_t atLimits = 0;              // active limits of joints or joint speeds
    bool graspHeld = false;             // the grasp stopped because a finger would have entered a region
    bool singular = false;              // near a singularity: the solution is damped
    bool flipped = false;               // left a singularity to another side than it came from
};

inline constexpr double kStaleAfter = 0.1; // [s] scene age from which forces fade

// Whether forces fade for the age of the scene. A negative age beyond the limit comes from stamps of another
// clock and says nothing about the scene.
inline bool isOld(double sceneAge) noexcept {
    return std::abs(sceneAge) > kStaleAfter;
}

// One row of haptics.csv, and further values for the window.
struct StepRecord {
    double t = 0.0; // [s]
    Pose device;    // base_T_tool that the hand commands, mapped
    Pose tool;      // base_T_tool of the proxy after the step
    Wrench wrench;  // on the hand, base axes, after all limits, before projection
    // Active rows of the last solve; one more if the exact check alone blocks the tool.
    uint32_t contactCount = 0;
    double minGap = kNotKnown; // [m] over the contact set after the step; its reach when none is nearer
    StepState state = StepState::Off;
    double guidance = 0.0;       // weight: 0 off .. 1 full pull
    int64_t frame = -1;          // index of the frame behind the active set
    double sceneAge = kNotKnown; // [s]
    bool stalled = false;        // cut by the trust region
    double marginPassive = kNotKnown,
           marginUncoupled = kNotKnown; // [N s/m] of damping left; NaN = the device's damping is unknown

    ArmRecord arm;
    Wrench deviceWrench;     // for HapticDevice::write: device axes, about the handle, on actuated axes only
    Wrench residual;         // base axes: what the device cannot render
    bool adopted = false;    // StepInput::offered is active now
    bool finite = true;      // false: some number is not finite, and the wrench of this step is zero
    bool armHold = true;     // a real arm must stand still
    uint32_t solves = 0;     // linearisations
    uint32_t infeasible = 0; // solver calls without an answer
    int guidanceClass = -1;  // index into StepInput::guidance of the target that pulls
    Pose guidanceTarget;     // held and slewed; valid when guidanceClass >= 0
    std::array<Touch, kMaxTouches> touches; // the first touchCount entries are valid
    uint32_t touchCount = 0;
    uint32_t cause = 0; // why there is a force: bits of wrench_stage.h
    // [m] Smallest gap to the regions of points at any distance, measured up to some 10 ms before, in another
    // thread; infinity without such regions.
    double clearance = kNotKnown;
    double lag = 0.0;      // [m] tool to the pose that the rows alone allow
    dvec3 indexShift{0.0}; // [m] net displacement of the hand map by lags and vanished regions
    uint32_t vanished = 0; // times that regions disappeared while they pressed
};

} // namespace fathom
