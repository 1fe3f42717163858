// SPDX-License-Identifier: Apache-2.0
// Independent witness of the engine's promise: no tool leaf enters a region sphere of the active set beyond
// its allowance (the depth the pair had when the set came into force, shrinking, never growing; 0 if it did
// not touch).
#pragma once

#include "engine/contact/fixtures.h"
#include "engine/contact/region_grid.h"
#include "engine/contact/tool.h"

#include <cstdint>
#include <span>
#include <vector>

namespace fathom {

// Sees the poses alone, nothing of the solver: every depth is taken in float64 from the very floats of the
// set. A search round a leaf finds all spheres near it, and looks at these alone until the leaf has moved so
// far that another could touch: exact, and a tick in free water costs a few nanoseconds per leaf. Allocates;
// not for the haptic thread.
class PenetrationAudit {
public:
    explicit PenetrationAudit(const Tool& tool);

    // One tick: the set it obeyed, the grid built from that very set, base_T_tool it started from and ended
    // at. A new Fixtures::generation is a new set, and its allowances are the depths at `start`. Leaves in
    // `behind` (indices) are exempt from the promise: their depth is counted apart. A set without frame (-1)
    // is no set. Throws Error when the grid is not of the set's size or a pose is not finite.
    void tick(const Fixtures& set, const RegionGrid& grid, const Pose& start, const Pose& end,
              std::span<const uint32_t> behind = {});

    // The same for a tool whose leaves move among themselves: their centres in the base frame [m], in the
    // order of the tool that the constructor got. Throws Error when there are not as many.
    void tick(const Fixtures& set, const RegionGrid& grid, std::span<const dvec3> start,
              std::span<const dvec3> end, std::span<const uint32_t> behind = {});

    // Before a turn whose tool was put somewhere by something else than the engine (a real arm that stood
    // still): its allowances are the depths at that tick's start.
    void retake() { anySet_ = false; }

    // [m] largest depth of one leaf beyond its allowance, so far.
    double leafPenetration(size_t leaf) const { return leaves_[leaf].worst; }
    double maxPenetration() const { return maxPenetration_; } // [m] largest depth beyond the allowance
    double maxEscapeDepth() const { return maxEscapeDepth_; } // [m] largest depth inside the allowance
    double maxBehindDepth() const { return maxBehindDepth_; } // [m] largest depth of a leaf flagged behind
    uint64_t escapeTicks() const {
        return escapeTicks_;
    } // turns that ended with some depth inside the allowance
    uint64_t behindTicks() const { return behindTicks_; } // turns with a leaf flagged behind that touched
    uint64_t penetrationTicks() const {
        return penetrationTicks_;
    }                                         // turns that ended with depth beyond allowance
    uint64_t ticks() const { return ticks_; } // turns that had a set

private:
    struct Candidate {
        uint32_t sphere;  // index in the set
        double allowance; // [m] >= 0
    };
    struct Leaf {
        dvec3 centre;                      // tool frame [m]
        double radius;                     // [m]
        dvec3 searchedAt{0.0};             // about the set's origin: where the last search was
        double mayMove = 0.0;              // [m] from there, before any sphere but the candidates can touch
        std::vector<Candidate> candidates; // all that were near there
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
    void audit(const Fixtures& set, const RegionGrid& grid, std::span<const uint32_t> behind);
    Worst judge(Leaf& leaf, const dvec3& centre);

    std::vector<Leaf> leaves_;
    std::vector<dvec3> start_,
        end_;                       // scratch, a leaf each: about the set's origin, before and after the tick
    std::vector<double> allowed_;   // scratch, a sphere each: allowance for the leaf at hand [m], else 0
    std::vector<Candidate> before_; // scratch
    std::vector<uint8_t> behind_;   // a leaf: flagged in this tick
    const Fixtures* set_ = nullptr; // during tick() only
    const RegionGrid* grid_ = nullptr;
    uint64_t generation_ = 0;
    size_t placed_ = 0; // finite spheres of the set: what its grid must hold
    bool anySet_ = false;

    double maxPenetration_ = 0.0, maxEscapeDepth_ = 0.0, maxBehindDepth_ = 0.0;
    uint64_t escapeTicks_ = 0, behindTicks_ = 0, penetrationTicks_ = 0, ticks_ = 0;
};

} // namespace fathom
