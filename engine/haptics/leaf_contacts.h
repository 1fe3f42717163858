// SPDX-License-Identifier: Apache-2.0
// Everything that the leaves of a tool or an arm can touch: the active contact set with its trust region,
// leaves behind a surface, and placed shapes.
#pragma once

#include "engine/contact/contact_set.h"
#include "engine/contact/narrow_phase.h"
#include "engine/contact/shapes.h"
#include "engine/haptics/held_leaves.h"
#include "engine/haptics/proxy_rows.h"
#include "engine/haptics/tool_motion.h"

#include <span>
#include <vector>

namespace fathom {

// Leaf centres at present and after the tried step, about `origin`.
struct LeafState {
    LeafCentres now, next;
    dvec3 origin{0.0}; // [m] base frame: origin of the active set

    double travel() const noexcept { return leafDisplacement(now, next); } // [m] largest leaf displacement
};

// One thread. Allocates in the constructor only; everything else is noexcept.
class LeafContacts {
public:
    static constexpr size_t kMaxShapes = Scene::kMaxFixtures; // of setShapes(): each row places at most one

    LeafContacts(const Tool& tool, std::span<const Shape> shapes, double stepCap,
                 const RowReduction& reduction);

    // Selects the active set, null = none. Its origin is used; without a set, `origin` is. False when the set
    // belongs to another tool: it is then not used.
    bool use(const ContactSet* set, const dvec3& origin) noexcept;
    const ContactSet* set() const noexcept { return set_; }
    // Finds the pairs near the leaves at `now` and the leaves behind a surface. centre: the tool's [m], base
    // frame. anew: false when the set is the same as in the last call.
    void gather(const dvec3& centre, bool anew) noexcept;
    std::span<const ContactRow> pairRows() const noexcept;
    std::span<const ContactRow> smoothRows() const noexcept;
    bool anyBehind() const noexcept;
    // The pair would hold a leaf behind its surface.
    bool holdsBehind(const ContactRow& row) const noexcept;
    // The rows that bring leaves back in front, with offset 0. Valid until the next call.
    std::span<const ContactRow> behindRows(const dvec3& centre) noexcept;
    bool overlaps() const noexcept { return set_ != nullptr && narrow_.smallestGap() < -proxy::kNegligible; }

    // Exact check of every listed pair on the straight path to `next`. Returns the number of leaves with a
    // violation; violations() has at most as many as there is room for.
    size_t check() noexcept;
    std::span<const NarrowPhase::Violation> violations() const noexcept;
    bool insideTrustRegion() const noexcept;
    const TrustRegion& trust() const noexcept { return trust_; }
    double smallestGap() noexcept; // [m] over all listed pairs at `now`
    // [m] leaf travel up to which the tangent planes of these rows, made at `now`, differ from the regions by
    // less than kTangentError. Infinite if all rows are of planes or keep_in boxes.
    double tangentTravel(std::span<const ActiveContact> rows) const noexcept;
    static constexpr double kTangentError = 0.0005; // [m]

    void setShapes(std::span<const Shape> shapes) noexcept;
    std::span<const Shape> shapes() const noexcept { return shapes_; }
    // Nothing moves this leaf: regions and shapes do not count for it.
    void exclude(size_t leaf) noexcept;
    // Chooses the leaves that keep_in shapes hold; those at `now` that are outside are not. Without this call
    // they hold all.
    void chooseHeld(double keeps) noexcept {
        held_.choose(shapes_, leaves.now, leaves.origin, radius_, keeps);
    }
    bool holds(size_t shape, size_t leaf) const noexcept { return held_.holds(shape, leaf); }
    double radius(size_t leaf) const noexcept { return radius_[leaf]; }
    size_t leafCount() const noexcept { return radius_.size(); }

    LeafState leaves;

private:
    void flagBehind() noexcept;

    std::vector<double> radius_; // [m] per leaf
    std::vector<Shape> shapes_;
    HeldLeaves held_;
    double rowLimit_, checkLimit_; // [m] largest gap of rows, and of pairs that one step can reach
    NarrowPhase narrow_;
    TrustRegion trust_;
    const ContactSet* set_ = nullptr;
    std::vector<dvec3> exempt_;    // per leaf: direction to the camera while it is behind, else zero
    bool flagged_ = false;         // some leaf may have one
    std::vector<double> distance_; // [m] per leaf: distance left in that direction
    std::vector<ContactRow> behind_;
    std::vector<NarrowPhase::Violation> violations_;
    size_t violationCount_ = 0;
};

// Key of a row that belongs to no sphere, the same in every tick. side: below 256, stored in the low byte.
uint64_t rowKey(ContactRow::Kind kind, uint32_t shape, uint32_t leaf, size_t side) noexcept;

// True when a line or axis allows the move between the poses: the distance and angle to it do not grow, or
// the tool stays on it.
bool equalityAllows(const Shape& shape, const Pose& from, const Pose& to) noexcept;

} // namespace fathom
