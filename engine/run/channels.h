// SPDX-License-Identifier: Apache-2.0
// The only paths between the threads of a run: mailboxes, queues and a pool of contact sets.
#pragma once

#include "engine/contact/contact_set.h"
#include "engine/cycle/frame_cycle.h"
#include "engine/haptics/proxy.h"
#include "engine/run/arm_link.h"
#include "engine/run/scene_update.h"
#include "engine/types/haptic_device.h"
#include "engine/types/lease_pool.h"
#include "engine/types/spsc_queue.h"
#include "engine/types/triple_buffer.h"

#include <array>
#include <atomic>
#include <vector>

namespace fathom {

// Window to haptic thread: the placed shapes from now on.
struct ShapeList {
    uint32_t count = 0;
    std::array<Shape, Proxy::kMaxShapes> shapes;
};

// Haptic thread to writer: one step.
struct TickRow {
    StepRecord record;
    HandSample hand;         // raw, from the device
    ToolPlace start;         // before the step
    uint64_t generation = 0; // of the fixture set behind the active contacts; 0 = none
    uint64_t query = 0;      // number of the query behind the active contact set; 0 = none
    double wokenLate = 0.0;  // [s] from the due time to the start of the step
    double micros = 0.0;     // [us] compute time of the step
    bool late = false;       // ended more than one period after it was due
    uint32_t missed = 0;     // periods before this one without a step
    bool driven = false;     // a real arm follows
    bool placed = false;     // the step started from where that arm was measured
    ArmStatus armStatus;     // status of that arm before the step
};

// Contact thread to writer: one answer. The audit exempts leaves that are behind a surface.
struct QueryNote {
    uint64_t query = 0;
    double micros = 0.0;
    std::vector<uint32_t> behind; // leaves
};

// Frame thread to writer: a frame and the host copy of its set. The writer returns it for reuse.
struct PublishedFrame {
    FrameReport report;
    double t = 0.0;       // [s] capture time in the run
    bool changed = false; // false: the source repeated its frame, no new set
    HostFixtures fixtures;
    RegionGrid grid; // over fixtures.spheres
    std::vector<uint32_t> colour;
    uint64_t edit = 0;      // with a window: number of the newest edit of fixtures that the set contains
    bool allFrozen = false; // the pilot has frozen all fixtures: no set is made
};

// One thread at each end, named by its cadence. Sized once; only QueryNote::behind may grow, on the contact
// thread.
struct Channels {
    // tickCapacity: number of steps that the writer may lag behind.
    explicit Channels(uint64_t tickCapacity)
        : contacts(2, [] { return std::make_unique<ContactSet>(); })
        , ticks(tickCapacity)
        , queries(tickCapacity)
        , frames(kFramesInFlight)
        , emptied(2 * kFramesInFlight) {}

    TripleBuffer<SceneUpdate> scene;           // frame -> haptic
    TripleBuffer<QueryPlace> queryAt;          // haptic -> contact
    TripleBuffer<ToolPlace> clearanceAt;       // haptic -> clearance: where the tool is
    TripleBuffer<double> clearance{kNotKnown}; // clearance -> haptic [m]
    PostureTrack postures;               // haptic -> frame: recent postures of the arm, for the self-filter
    TripleBuffer<ShapeList> shapes;      // window -> haptic
    LeasePool<ContactSet> contacts;      // contact -> haptic: two leases, active and on offer
    SpscQueue<TickRow> ticks;            // haptic -> writer
    SpscQueue<QueryNote> queries;        // contact -> writer
    SpscQueue<PublishedFrame*> frames;   // frame -> writer
    SpscQueue<PublishedFrame*> emptied;  // writer -> frame
    ArmLink* arm = nullptr;              // haptic <-> thread of a real arm; null = no real arm
    std::atomic<bool> hapticDone{false}; // the last wrench is written

    // Number of sets that the writer may keep for steps that still obey them.
    static constexpr uint64_t kFramesInFlight = 64;
};

} // namespace fathom
