// SPDX-License-Identifier: Apache-2.0
// Everything that passes between the threads of a realtime run, and nothing else does. Design 2.
#pragma once

#include "apps/binding/arm_link.h"
#include "devices/haptic_device.h"
#include "engine/contact/contact_set.h"
#include "engine/cycle/frame_cycle.h"
#include "engine/cycle/step_record.h"
#include "engine/haptics/proxy.h"
#include "engine/types/lease_pool.h"
#include "engine/types/spsc_queue.h"
#include "engine/types/triple_buffer.h"
#include "shaders/shared/frame_params.h"

#include <array>
#include <atomic>
#include <vector>

namespace fathom {

// Frame cadence to haptic cadence: what the newest fixture set brings besides its spheres. Times are of the
// run's clock [s].
struct SceneUpdate {
    int64_t frame = -1;
    uint64_t generation = 0;
    double captureTime = 0.0; // of the newest picture that shows it
    bool sourceEnded = false; // there will be no more: the last frame stays in force and does not age
    bool live = false;        // pictures come by themselves: the hand's path alone ends the run
    bool gone = false; // the camera, or the device of the passes; there may be more: the last frame ages
    uint32_t guidanceCount = 0;
    std::array<GuidancePose, shared::kMaxClasses> guidance;
};

// Window to haptic cadence: authored shapes as the pilot has them now.
struct ShapeList {
    uint32_t count = 0;
    std::array<Shape, Proxy::kSpareShapes> shapes;
};

// Haptic cadence to writer: one turn.
struct TickRow {
    StepRecord record;
    HandSample hand;         // raw, as the device gave it
    Pose start;              // base_T_tool that the turn started from
    ArmPosture startArm;     // and the arm, where there is one
    uint64_t generation = 0; // of the fixture set obeyed; 0 = none
    uint64_t query = 0;      // whose answer was obeyed; 0 = none
    double wokenLate = 0.0;  // [s] from when the turn was due to its start
    double micros = 0.0;     // [us] compute time of the turn
    bool late = false;       // ended more than one period after its start was due
    uint32_t missed = 0;     // periods before this one in which no turn ran
    bool driven = false;     // a real arm follows
    bool placed = false;     // the turn started from where that arm was measured
    ArmStatus told;          // by it, before the turn
};

// Contact cadence to writer: one answer. Its leaves behind a surface are exempt from the promise that the
// writer audits.
struct QueryNote {
    uint64_t query = 0;
    double micros = 0.0;
    std::vector<uint32_t> behind; // leaves
};

// Frame cadence to writer: a frame and the host copy of its set. Comes back to be filled again.
struct PublishedFrame {
    FrameReport report;
    double t = 0.0;       // [s] capture time in the run
    bool changed = false; // false: the same picture again, no new set
    Fixtures fixtures;
    RegionGrid grid; // over fixtures.spheres
    std::vector<uint32_t> colour;
    uint64_t edit = 0;  // of a window: number of the newest change of fixtures that the set obeys
    bool still = false; // and the pilot holds all of them: no set is made
};

// One thread at each end, named by the cadence. Sized once; only the note's vector may grow, on the contact
// cadence.
struct Crossings {
    // turns: how many the writer may fall behind.
    explicit Crossings(uint64_t turnCapacity)
        : contacts(2, [] { return std::make_unique<ContactSet>(); })
        , ticks(turnCapacity)
        , queries(turnCapacity)
        , frames(kFramesInFlight)
        , emptied(2 * kFramesInFlight) {}

    TripleBuffer<SceneUpdate> scene;     // frame -> haptic
    TripleBuffer<ToolState> proxy;       // haptic -> contact
    PostureTrack postures;               // haptic -> frame: where the arm was, for the self-filter
    TripleBuffer<ShapeList> shapes;      // window -> haptic
    LeasePool<ContactSet> contacts;      // contact -> haptic: two leases, in force and offered
    SpscQueue<TickRow> ticks;            // haptic -> writer
    SpscQueue<QueryNote> queries;        // contact -> writer
    SpscQueue<PublishedFrame*> frames;   // frame -> writer
    SpscQueue<PublishedFrame*> emptied;  // writer -> frame
    ArmLink* arm = nullptr;              // haptic <-> a real arm's thread; null = there is none
    std::atomic<bool> hapticDone{false}; // the last wrench is written

    static constexpr uint64_t kFramesInFlight =
        64; // sets that the writer may hold for records that still obey them
};

} // namespace fathom
