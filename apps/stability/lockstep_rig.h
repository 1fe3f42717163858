// SPDX-License-Identifier: Apache-2.0
// The haptic cycle in lockstep over fixture sets that a case makes: contact answers that come late or get
// lost, an independent audit of every pose, and the figures that cases ask for.
#pragma once

#include "engine/contact/behind.h"
#include "engine/contact/cull_cpu.h"
#include "engine/reference/penetration_audit.h"
#include "engine/run/active_contacts.h"

#include "apps/stability/rng.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <memory>
#include <optional>

namespace fathom::stability {

struct AnswerFaults {
    uint32_t late = 0;   // [turns] from query to answer
    bool jitter = false; // late by 0 .. late, drawn anew for each answer
    double lost = 0.0;   // share of the queries that are never answered
};

// By how much a magnitude rises from one tick to the next; a fall counts as 0.
struct Rise {
    double most = 0.0, squares = 0.0;
    uint64_t ticks = 0;

    void add(double rise) {
        most = std::max(most, rise);
        squares += rise > 0.0 ? rise * rise : 0.0;
        ++ticks;
    }
    double rms() const { return ticks > 0 ? std::sqrt(squares / static_cast<double>(ticks)) : 0.0; }
};

struct RigFigures {
    uint64_t ticks = 0, contact = 0, stalled = 0, trapped = 0, escape = 0, refused = 0, notFinite = 0;
    double path = 0.0;                        // [m] of the tool's centre
    double force = 0.0, torque = 0.0;         // largest [N], [N m]
    double forceStep = 0.0, torqueStep = 0.0; // largest between two ticks [N], [N m]
    // Of what the springs ask for, before the limits of size and slew rate.
    Rise askedForce, askedTorque; // [N], [N m]
};

// Options of a scene with one forbidden class on the device `ideal`.
HapticOptions plainHapticOptions(const Tool& tool);

struct RigSetup {
    double reach = 0.01; // [m] of the contact queries
    QueryCapacity capacity;
};

// One thread. The hand is the handle's pose; base and device frame are one.
class LockstepRig {
public:
    LockstepRig(const Tool& tool, const Pose& start, const RigSetup& setup = {});
    LockstepRig(const Tool& tool, const HapticOptions& options, const Pose& start,
                const RigSetup& setup = {});

    // News of the frame cadence: what the next query is asked of. The generation and the frame number are
    // given here.
    void show(Fixtures set);
    // From now on the set shown ages; otherwise every tick counts as a fresh image of the same.
    void freeze() { fresh_ = false; }

    StepRecord step(const Pose& hand);

    AnswerFaults faults;
    RigFigures figures;

    const PenetrationAudit& audit() const { return audit_; }
    const Tool& tool() const { return tool_; }
    const HapticOptions& options() const { return options_; }
    Pose pose() const { return cycle_->pose(); }
    const Fixtures& shown() const { return published_.back()->set; }
    const ContactSet* active() const { return contacts_.active(); }
    // Deepest leaf in the set shown, brute force; negative = the smallest gap [m].
    double depth() const;

private:
    struct Published {
        Fixtures set;
        RegionGrid grid;
    };
    struct Answer {
        uint64_t due;
        std::unique_ptr<ContactSet> set;
    };
    void ask();
    std::unique_ptr<ContactSet> arrived();
    const Published* published(uint64_t generation) const;
    void judge(const Pose& before, const StepRecord& record);
    void forgetOldSets();

    Tool tool_;
    HapticOptions options_;
    RigSetup setup_;
    std::unique_ptr<HapticCycle> cycle_;
    CullCpu cull_;
    BehindTracker behind_;
    PenetrationAudit audit_;
    Rng rng_{4711};
    std::deque<std::unique_ptr<Published>> published_; // oldest first; those that answers may still name
    std::deque<Answer> pending_;
    ActiveContacts<std::unique_ptr<ContactSet>> contacts_;
    uint64_t generation_ = 0, queries_ = 0, now_ = 0;
    double captured_ = 0.0;
    bool fresh_ = true;
    std::optional<Wrench> before_, askedBefore_;
};

} // namespace fathom::stability
