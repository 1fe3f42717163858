// SPDX-License-Identifier: Apache-2.0
// The contact cadence: a fixture set and a tool pose in, a certified contact set out, by the CPU or the GPU
// as the plan says.
#pragma once

#include "engine/cloud/tree_query.h"
#include "engine/contact/behind.h"
#include "engine/contact/cull_cpu.h"
#include "engine/cycle/arm_rig.h"
#include "engine/cycle/step_record.h"

#include <optional>

namespace fathom {

// One thread. Both ways give equal sets.
class ContactCycle {
public:
    // arm: null = the tool moves freely; else what is asked about is the whole arm, by its posture. Without
    // a device the CPU answers, whatever the plan says.
    ContactCycle(const Tool& tool, double reach, const ArmRig* arm);
    // The same, and use(). gpuCapacity: spheres of the first answer of a GPU; it doubles when they are more.
    ContactCycle(gpu::Device& device, const Plan& plan, const PatchLayout& layout, cloud::FixturePool& pool,
                 const Tool& tool, double reach, const ArmRig* arm = nullptr,
                 uint32_t gpuCapacity = kGpuCapacity);

    // What the plan wants of a device, from the next query on; and no device any more.
    void use(gpu::Device& device, const Plan& plan, const PatchLayout& layout, cloud::FixturePool& pool);
    void dropDevice() { gpu_.reset(); }

    // Without forbidden points the set is empty and its reach unlimited.
    void query(const cloud::FixtureSet& set, const Pose& baseTtool, ContactSet& out) {
        query(set, ToolState{baseTtool, {}}, out);
    }
    void query(const cloud::FixtureSet& set, const ToolState& place, ContactSet& out);

    QueryStatistics statistics() const;

private:
    static constexpr uint32_t kGpuCapacity = 65536;

    void ask(const Tool& tool, const cloud::FixtureSet& set, const Pose& baseTtool, ContactSet& out);

    const Tool& tool_;
    const ArmRig* arm_;
    double reach_;
    uint32_t gpuCapacity_ = kGpuCapacity;
    Plan::Query where_ = Plan::Query::Cpu;
    CullCpu cpu_;
    QueryLoop gpuLoop_;
    std::optional<cloud::TreeQuery> gpu_;
    BehindTracker behind_;
    uint64_t queries_ = 0;
};

} // namespace fathom
