// SPDX-License-Identifier: Apache-2.0
// The contact cadence: a fixture set and a tool pose in, a certified contact set out, by the CPU or the GPU
// as the plan says.
#pragma once

#include "engine/cloud/tree_query.h"
#include "engine/contact/behind.h"
#include "engine/contact/cull_cpu.h"

#include <optional>

namespace fathom {

// One thread. Both ways give equal sets.
class ContactCycle {
public:
    ContactCycle(gpu::Device& device, const Plan& plan, const PatchLayout& layout, cloud::FixturePool& pool,
                 const Tool& tool, double reach);

    // Without forbidden points the set is empty and its reach unlimited.
    void query(const cloud::FixtureSet& set, const Pose& baseTtool, ContactSet& out);

    QueryStatistics statistics() const;

private:
    const Tool& tool_;
    double reach_;
    Plan::Query where_;
    CullCpu cpu_;
    QueryLoop gpuLoop_;
    std::optional<cloud::TreeQuery> gpu_;
    BehindTracker behind_;
};

} // namespace fathom
