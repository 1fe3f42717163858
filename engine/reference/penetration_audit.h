// SPDX-License-Identifier: Apache-2.0
// Independent check of the engine's guarantee: no tool leaf enters a region sphere of the active set beyond
// its allowance. The allowance is the depth of the pair when the set became active (0 without contact). It
// shrinks with the depth and never grows.
#pragma once

#include "engine/contact/host_fixtures.h"
#include "engine/contact/region_grid.h"
#include "engine/contact/tool.h"

#include <cstdint>
#include <span>
#include <vector>

namespace fathom {

// Uses only the poses, not the solver: computes every depth in float64 from the floats of the set. A search
// around a leaf finds all near spheres, and only these are tested until the leaf has moved far enough to
// touch another one. So the audit is exact, and a tick in free space costs a few nanoseconds per leaf.
// Allocates; not for the haptic thread.
class PenetrationAudit {
public:
    explicit PenetrationAudit(const Tool& tool);

    // Audits one tick. set: the set that the step obeyed. grid: built from that set. start, end: base_T_tool
    // before and after. With a new HostFixtures::generation, the allowances become the depths at `start`.
    // Leaves in `behind` (indices) are exempt from the guarantee and counted separately. A set with frame -1
    // is ignored. Throws Error when the grid does not fit the set or a pose is not finite.
    void tick(const HostFixtures& set, const RegionGrid& grid, const Pose& start, const Pose& end,
              std::span<const uint32_t> behind = {});

    // The same for a tool whose leaves move relative to each other: takes their centres in the base frame
    // [m], in the order of the constructor's tool. Throws Error when their number differs.
    void tick(const HostFixtures& set, const RegionGrid& grid, std::span<const dvec3> start,
              std::span<const dvec3> end, std::span<const uint32_t> behind = {});

    // Call before a tick whose tool was moved by something other than the engine (a real arm that stood
    // still). Allowances restart from the depths at the start of that tick.
    void retake() { anySet_ = false; }

    // [m] largest depth of one leaf beyond its allowance, so far.
    double leafPenetration(size_t leaf) const { return leaves_[leaf].worst; }
    double maxPenetration() const { return maxPenetration_; } // [m] largest depth beyond the allowance
    double maxEscapeDepth() const { return maxEscapeDepth_; } // [m] largest depth inside the allowance
    // [m] largest depth of a leaf flagged behind; for tests
    double maxBehindDepth() const { return maxBehindDepth_; }
    // ticks that ended with some depth inside the allowance
    uint64_t escapeTicks() const { return escapeTicks_; }
    uint64_t behindTicks() const { return behindTicks_; } // ticks in which a leaf flagged behind touched
    // ticks that ended with some depth beyond the allowance; for tests
    uint64_t penetrationTicks() const { return penetrationTicks_; }
    uint64_t ticks() const { return ticks_; } // ticks with a set

private:
    struct Candidate {
        uint32_t sphere;  // index in the set
        double allowance; // [m] >= 0
    };
    struct Leaf {
        dvec3 centre;          // tool frame [m]
        double radius;         // [m]
        dvec3 searchedAt{0.0}; // relative to the set's origin: place of the last search
        double mayMove = 0.0;  // [m] distance from there within which only the candidates can touch
        std::vector<Candidate> candidates; // all spheres near that place
        double worst = 0.0;                // [m] beyond the allowance, over all ticks
    };
    struct Worst {
        double beyond = 0.0, inside = 0.0, any = 0.0; // [m]
    };

    double gapTo(const Leaf& leaf, const dvec3& centre, uint32_t sphere) const;
    void search(Leaf& leaf, const dvec3& centre);
    dvec3 centreOf(const Leaf& leaf, const Pose& pose) const;
    void checkGrid() const;
    void takeAllowances();
    void audit(const HostFixtures& set, const RegionGrid& grid, std::span<const uint32_t> behind);
    Worst judge(Leaf& leaf, const dvec3& centre);

    std::vector<Leaf> leaves_;
    // scratch, per leaf: relative to the set's origin, before and after the tick
    std::vector<dvec3> start_, end_;
    std::vector<double> allowed_;       // scratch, per sphere: allowance for the current leaf [m], else 0
    std::vector<Candidate> before_;     // scratch
    std::vector<uint8_t> behind_;       // per leaf: flagged in this tick
    const HostFixtures* set_ = nullptr; // during tick() only
    const RegionGrid* grid_ = nullptr;
    uint64_t generation_ = 0;
    size_t placed_ = 0; // finite spheres of the set, as many as its grid must have
    bool anySet_ = false;

    double maxPenetration_ = 0.0, maxEscapeDepth_ = 0.0, maxBehindDepth_ = 0.0;
    uint64_t escapeTicks_ = 0, behindTicks_ = 0, penetrationTicks_ = 0, ticks_ = 0;
};

} // namespace fathom
