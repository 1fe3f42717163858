// SPDX-License-Identifier: Apache-2.0
#include "engine/haptics/leaf_contacts.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fathom {

namespace {

constexpr size_t kMaxViolations = 64;
constexpr double kEqualityRest = 1e-9; // [m], [rad] lines and axes: closer than this is on them

} // namespace

LeafContacts::LeafContacts(const Tool& tool, std::span<const Shape> shapes, double stepCap,
                           const RowReduction& reduction)
    : leaves{LeafCentres(tool.leafCount()), LeafCentres(tool.leafCount())}
    , shapes_(shapes.begin(), shapes.end())
    , held_(tool.leafCount(), std::max(kMaxShapes, shapes.size()))
    // Larger than the cap by rounding only: the check must include every pair that one step can reach.
    , checkLimit_(stepCap * (1.0 + 1e-6) + proxy::kSkin)
    , narrow_(tool, proxy::kMaxPairRows, reduction.cone, reduction.smooth)
    , trust_(tool.leafCount())
    , exempt_(tool.leafCount(), dvec3(0.0))
    , distance_(tool.leafCount(), 0.0)
    , violations_(kMaxViolations) {
    rowLimit_ = std::max(reduction.reach * stepCap, checkLimit_);
    for (const Sphere& leaf : tool.leaves()) {
        radius_.push_back(leaf.radius);
    }
    behind_.reserve(radius_.size());
    shapes_.reserve(std::max(kMaxShapes, shapes_.size()));
}

void LeafContacts::setShapes(std::span<const Shape> shapes) noexcept {
    const size_t count = std::min(shapes.size(), shapes_.capacity());
    shapes_.assign(shapes.begin(), shapes.begin() + static_cast<std::ptrdiff_t>(count));
}

void LeafContacts::exclude(size_t leaf) noexcept {
    held_.exclude(leaf);
    narrow_.exclude(leaf);
}

bool LeafContacts::use(const ContactSet* set, const dvec3& origin) noexcept {
    const bool usable = set == nullptr || set->leafAtQuery.size() == radius_.size();
    set_ = usable ? set : nullptr;
    leaves.origin = set_ != nullptr ? set_->origin : origin;
    return usable;
}

void LeafContacts::gather(const dvec3& centre, bool anew) noexcept {
    if (set_ != nullptr) {
        narrow_.gather(*set_, leaves.now, centre - set_->origin, rowLimit_, checkLimit_, anew);
        trust_.set(*set_, leaves.now);
        flagBehind();
    }
}

// Flags found by the query, except for leaves that have been brought out since.
void LeafContacts::flagBehind() noexcept {
    if (flagged_) {
        std::fill(exempt_.begin(), exempt_.end(), dvec3(0.0));
    }
    flagged_ = !set_->behind.empty();
    for (const ContactSet::Behind& flag : set_->behind) {
        const dvec3 since = leaves.now[flag.leaf] - set_->leafAtQuery[flag.leaf];
        const double left = flag.distance - glm::dot(since, flag.towardsCamera);
        if (left > 0.0 && !held_.excluded(flag.leaf)) {
            exempt_[flag.leaf] = flag.towardsCamera;
            distance_[flag.leaf] = left;
        }
    }
}

std::span<const ContactRow> LeafContacts::pairRows() const noexcept {
    return set_ != nullptr ? narrow_.rows() : std::span<const ContactRow>{};
}

std::span<const ContactRow> LeafContacts::smoothRows() const noexcept {
    return set_ != nullptr ? narrow_.smoothRows() : std::span<const ContactRow>{};
}

bool LeafContacts::anyBehind() const noexcept {
    return set_ != nullptr && std::any_of(set_->behind.begin(), set_->behind.end(),
                                          [&](const auto& flag) { return exempt_[flag.leaf] != dvec3(0.0); });
}

bool LeafContacts::holdsBehind(const ContactRow& row) const noexcept {
    const dvec3& out = exempt_[row.leaf];
    return out != dvec3(0.0) && glm::dot(row.normal, out) < NarrowPhase::kCosHolds;
}

std::span<const ContactRow> LeafContacts::behindRows(const dvec3& centre) noexcept {
    behind_.clear();
    for (size_t i = 0; set_ != nullptr && i < set_->behind.size(); ++i) {
        const uint32_t leaf = set_->behind[i].leaf;
        const bool again = !behind_.empty() && behind_.back().leaf == leaf;
        if (again || exempt_[leaf] == dvec3(0.0) || behind_.size() == behind_.capacity()) {
            continue;
        }
        ContactRow row;
        row.kind = ContactRow::Kind::Behind;
        row.normal = exempt_[leaf];
        row.arm = leaves.now[leaf] - (centre - set_->origin);
        row.leaf = leaf;
        row.gap = -distance_[leaf];
        row.key = rowKey(row.kind, 0, leaf, 0);
        behind_.push_back(row);
    }
    return behind_;
}

size_t LeafContacts::check() noexcept {
    violationCount_ = set_ == nullptr ? 0 : narrow_.check(*set_, leaves.next, exempt_, violations_);
    return violationCount_;
}

std::span<const NarrowPhase::Violation> LeafContacts::violations() const noexcept {
    return {violations_.data(), std::min(violationCount_, violations_.size())};
}

bool LeafContacts::insideTrustRegion() const noexcept {
    return set_ == nullptr || trust_.contains(*set_, leaves.next);
}

double LeafContacts::smallestGap() noexcept {
    return set_ == nullptr ? std::numeric_limits<double>::quiet_NaN()
                           : narrow_.smallestGapAt(*set_, leaves.now);
}

double LeafContacts::tangentTravel(std::span<const ActiveContact> rows) const noexcept {
    double travel = std::numeric_limits<double>::infinity();
    const auto onCurve = [](double radius) { return std::sqrt(2.0 * radius * kTangentError); };
    for (const ActiveContact& active : rows) {
        const ContactRow& row = active.row;
        if (row.kind == ContactRow::Kind::Sphere) {
            travel = std::min(travel, onCurve(radius_[row.leaf] + double{set_->pairRadius[row.pair]}));
        } else if (row.kind == ContactRow::Kind::Shape) {
            const Shape& shape = shapes_[row.pair];
            const double onShape = shape.isRound() ? onCurve(radius_[row.leaf] + shape.size.x)
                                                   : std::numeric_limits<double>::infinity();
            // Beyond a face's edge the leaf goes round the edge.
            const double toEdge = edgeDistance(shape, leaves.now[row.leaf] + leaves.origin);
            travel = std::min({travel, onShape, toEdge + onCurve(radius_[row.leaf])});
        }
    }
    return travel;
}

uint64_t rowKey(ContactRow::Kind kind, uint32_t shape, uint32_t leaf, size_t side) noexcept {
    return (static_cast<uint64_t>(kind) << 60) | (static_cast<uint64_t>(shape) << 40) |
           (static_cast<uint64_t>(leaf) << 8) | side;
}

bool equalityAllows(const Shape& shape, const Pose& from, const Pose& to) noexcept {
    std::array<Equality, kMaxEqualities> before, after;
    const size_t count = equalitiesOf(shape, from, before);
    equalitiesOf(shape, to, after);
    for (size_t k = 0; k < count; k += 2) { // first the distance, then the angle
        const double was = std::hypot(before[k].error, before[k + 1].error);
        if (!(std::hypot(after[k].error, after[k + 1].error) <= std::max(kEqualityRest, was))) {
            return false;
        }
    }
    return true;
}

} // namespace fathom
