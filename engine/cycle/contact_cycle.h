// SPDX-License-Identifier: Apache-2.0
// The contact cadence: from a fixture set and a tool pose to a complete contact set, on the CPU or GPU as
// planned.
#pragma once

#include "engine/cloud/tree_query.h"
#include "engine/contact/behind.h"
#include "engine/contact/cull_cpu.h"
#include "engine/cycle/arm_setup.h"
#include "engine/cycle/step_record.h"

#include <optional>

namespace fathom {

// One thread. CPU and GPU give equal sets.
class ContactCycle {
public:
    // arm: null = the tool moves freely; else queries cover the whole arm at its posture. Without a device
    // the CPU answers.
    ContactCycle(const Tool& tool, double reach, const ArmSetup* arm);
    // The same, then use(). capacity: of the first contact sets.
    ContactCycle(const cloud::QueryContext& context, const Tool& tool, double reach,
                 const ArmSetup* arm = nullptr, const QueryCapacity& capacity = {});

    // From the next query on: use() works on the device as the plan requires, dropDevice() on the CPU. A
    // device whose arithmetic fails a test at use() is not used, with a warning.
    void use(const cloud::QueryContext& context);
    void dropDevice() { gpu_.reset(); }
    bool onDevice() const { return gpu_.has_value(); } // the device answers

    // Without forbidden points the contact set is empty and its reach is unlimited.
    void query(const cloud::FixtureSet& set, const Pose& baseTtool, ContactSet& out) {
        query(set, QueryPlace{{baseTtool, {}}}, out);
    }
    void query(const cloud::FixtureSet& set, const QueryPlace& at, ContactSet& out);

    QueryStatistics statistics() const;

private:
    void askDevice(const Tool& tool, const cloud::FixtureSet& set, const Pose& baseTtool, double reach,
                   ContactSet& out);
    void ask(const Tool& tool, const cloud::FixtureSet& set, const Pose& baseTtool, double reach,
             ContactSet& out);

    const Tool& tool_;
    const ArmSetup* arm_;
    double reach_;
    Plan::Query where_ = Plan::Query::Cpu;
    PatchLayout layout_;
    CullCpu cpu_;
    QueryLoop gpuLoop_;
    std::optional<cloud::TreeQuery> gpu_;
    NearPairs near_;
    DecideScratch scratch_;
    BehindTracker behind_;
    uint64_t queries_ = 0;
};

} // namespace fathom
