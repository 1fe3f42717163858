// SPDX-License-Identifier: Apache-2.0
// From a contact set and a pose to the few rows that the solver needs, and the exact check of every listed pair.
#pragma once

#include "engine/contact/contact_row.h"
#include "engine/contact/contact_set.h"

#include <cstdint>
#include <span>
#include <vector>

namespace fathom {

// One thread; allocates in the constructor only, everything else is noexcept and wait-free.
class NarrowPhase {
public:
    // Rows are kept to the `maxRows` deepest.
    NarrowPhase(const Tool& tool, size_t maxRows);

    // Leaf centres are about set.origin [m], one a leaf of the tool. Finds for each leaf, among listed pairs with gap <=
    // rowLimit, the nearest and the nearest in each further 30 degree normal cone: rows(). Remembers all pairs with gap
    // <= checkLimit for check(); checkLimit <= rowLimit. camera: fallback normal's way, about the origin.
    void gather(const ContactSet& set, std::span<const dvec3> leaves, const dvec3& toolCentre, double rowLimit,
                double checkLimit) noexcept;

    std::span<const ContactRow> rows() const { return {rows_.data(), rowCount_}; }
    // Distance of each leaf from where it was at the query [m]; of the last gather().
    std::span<const double> moved() const { return moved_; }
    double smallestGap() const { return smallestGap_; } // [m] among pairs up to rowLimit; rowLimit when there is none

    // A pair that a motion would take in too deep: below min(0, its gap at the start), anywhere on the straight way of
    // its leaf.
    struct Violation {
        ContactRow row; // of the pair at the start of the motion; offset 0
        double depth;   // [m] > 0, beyond what is allowed
    };

    // Exact test of every listed pair for leaves that go from where gather() saw them to `next`, none farther than its
    // checkLimit. `exempt[leaf]`, when not zero, is the way to the camera of a leaf behind a surface: its pairs whose
    // normal points away from it do not count. Writes the worst of each leaf, at most out.size(); returns how many leaves
    // violate (more than out.size() is possible).
    size_t check(const ContactSet& set, std::span<const dvec3> next, std::span<const dvec3> exempt,
                 std::span<Violation> out) noexcept;

    // Smallest gap over all listed pairs with the leaves at `leaves` [m]; set.reach when none is nearer.
    double smallestGapAt(const ContactSet& set, std::span<const dvec3> leaves) noexcept;

private:
    struct Near {
        dvec3 delta; // leaf - sphere
        double distance, gap;
        uint32_t pair;
    };
    void gatherLeaf(const ContactSet& set, uint32_t leaf, double rowLimit, double checkLimit) noexcept;
    void remember(const ContactSet& set, uint32_t pair) noexcept;
    void chooseRows(const ContactSet& set, uint32_t leaf, size_t firstRow) noexcept;
    ContactRow rowOf(const ContactSet& set, uint32_t leaf, const dvec3& delta, double gap, uint32_t pair) noexcept;
    bool checkLeaf(const ContactSet& set, uint32_t leaf, const dvec3& next, const dvec3& exempt,
                   Violation* worst) noexcept;

    std::vector<double> radius_; // of the leaves
    size_t maxRows_;
    std::vector<ContactRow> rows_;
    size_t rowCount_ = 0;
    std::vector<dvec3> leaves_;     // of the last gather()
    std::vector<dvec3> lastNormal_; // of each leaf's deepest row; zero = none yet
    std::vector<double> moved_;
    dvec3 toolCentre_{0.0};
    double smallestGap_ = 0.0;
    double checkLimit_ = 0.0;

    // Pairs that one step can reach, grouped by leaf. When they do not fit, check() reads the set itself.
    std::vector<float> x_, y_, z_, sphereRadius_;
    std::vector<uint32_t> pair_;
    std::vector<uint32_t> begin_; // leaves + 1
    size_t remembered_ = 0;
    bool allRemembered_ = true;

    std::vector<double> gaps_; // of one chunk
    std::vector<Near> near_;
    size_t nearCount_ = 0;
};

} // namespace fathom
