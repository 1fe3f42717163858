// SPDX-License-Identifier: Apache-2.0
// The haptic cycle in lockstep over a case's fixture sets. Contact answers can be late or lost. Audits every
// pose independently and collects the figures that cases check.
#pragma once

#include "engine/contact/behind.h"
#include "engine/contact/cull_cpu.h"
#include "engine/reference/penetration_audit.h"
#include "engine/run/active_contacts.h"

#include "engine/reference/rng.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <memory>
#include <optional>

namespace fathom::stability {

struct AnswerFaults {
    uint32_t late = 0;   // [ticks] from query to answer
    bool jitter = false; // a random delay of 0 .. late for each answer
    double lost = 0.0;   // fraction of queries that are never answered
};

// Rise of a magnitude from one tick to the next; a fall counts as 0.
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
    double path = 0.0;                        // [m] travelled by the tool's centre
    double force = 0.0, torque = 0.0;         // largest [N], [N m]
    double forceStep = 0.0, torqueStep = 0.0; // largest between two ticks [N], [N m]
    // Rises of the delivered force and torque from tick to tick.
    Rise forceRise, torqueRise; // [N], [N m]
};

// Options for a scene with one forbidden class and the device `ideal`.
HapticOptions plainHapticOptions(const Tool& tool);

struct RigSetup {
    double reach = 0.01; // [m] reach of the contact queries
    QueryCapacity capacity;
};

// For one thread. The hand is the pose of the handle. The base frame equals the device frame.
class LockstepRig {
public:
    LockstepRig(const Tool& tool, const Pose& start, const RigSetup& setup = {});
    LockstepRig(const Tool& tool, const HapticOptions& options, const Pose& start,
                const RigSetup& setup = {});

    // Publishes a new frame's fixture set; the next query uses it. Sets its generation and frame number.
    void show(HostFixtures set);
    // From now on the shown set ages. Without this, every tick counts as a new frame with the same content.
    void freeze() { fresh_ = false; }

    StepRecord step(const Pose& hand);

    AnswerFaults faults;
    RigFigures figures;

    const PenetrationAudit& audit() const { return audit_; }
    const Tool& tool() const { return tool_; }
    const HapticOptions& options() const { return options_; }
    Pose pose() const { return cycle_->pose(); }
    const HostFixtures& shown() const { return published_.back()->set; }
    const ContactSet* active() const { return contacts_.active(); }
    // Depth of the deepest leaf in the shown set by brute force [m]; negative: the smallest gap.
    double depth() const;

private:
    struct Published {
        HostFixtures set;
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
    std::deque<std::unique_ptr<Published>> published_; // oldest first, while answers can name them
    std::deque<Answer> pending_;
    ActiveContacts<std::unique_ptr<ContactSet>> contacts_;
    uint64_t generation_ = 0, queries_ = 0, now_ = 0;
    double captured_ = 0.0;
    bool fresh_ = true;
    std::optional<Wrench> before_;
};

} // namespace fathom::stability
