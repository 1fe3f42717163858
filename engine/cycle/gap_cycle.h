// SPDX-License-Identifier: Apache-2.0
// Finds the smallest gap of a tool at each of many poses (a batch). The device answers where it also answers
// contact queries, else the CPU; both give the same answers to the last bit.
#pragma once

#include "engine/cloud/gap_query.h"

#include <optional>

namespace fathom {

// One thread at a time.
class GapCycle {
public:
    // From the next batch on: use() works on the device, dropDevice() on the CPU. The pipeline is compiled
    // with the first batch. What the context refers to must last until the next use() or dropDevice().
    void use(const cloud::QueryContext& context);
    void dropDevice();

    // Fills `out` with one answer per pose. Throws DeviceFailed.
    void find(const cloud::FixtureSet& set, const Tool& tool, std::span<const Pose> baseTtool,
              std::vector<SmallestGap>& out);

private:
    void findOnHost(const HostFixtures& set, const Tool& tool, std::span<const Pose> baseTtool,
                    std::vector<SmallestGap>& out);

    std::optional<cloud::QueryContext> context_;
    std::optional<cloud::GapQuery> gpu_;
    GapSearch cpu_;
    const HostFixtures* searched_ = nullptr; // what cpu_ was built from
    uint64_t generation_ = 0;                // and its generation
};

} // namespace fathom
