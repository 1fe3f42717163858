// SPDX-License-Identifier: Apache-2.0
// The rows of one linearisation: region spheres, leaves behind a surface, authored shapes.
#include "engine/haptics/proxy.h"

#include "engine/haptics/proxy_limits.h"
#include "engine/haptics/row_rules.h"

#include <algorithm>
#include <cmath>

namespace fathom {

namespace {

using proxy::kSkin;
using proxy::rowKey;

} // namespace

// Separated: what keeps the leaf out, and the skin. Overlapping: out again, as far as the turn's budget goes.
double Proxy::offsetFor(double gap, const Budget& budget) const noexcept {
    if (gap >= 0.0) {
        return kSkin - gap;
    }
    const double left = budget.travel > kSkin ? budget.depth : 0.0;
    return std::max(kSkin, std::min(kSkin - gap, left));
}

bool Proxy::addRow(ContactRow row) noexcept {
    if (rowCount_ == rows_.size()) {
        return false;
    }
    if (row.offset > proxy::kEscapeThreshold) {
        escaping_ = true;
        largestAsked_ = std::max(largestAsked_, row.offset);
    }
    rows_[rowCount_++] = row;
    return true;
}

void Proxy::collectRows(const ContactSet* contacts, const Budget& budget) noexcept {
    rowCount_ = 0;
    escaping_ = false;
    largestAsked_ = 0.0;
    touching_ = false;
    if (contacts != nullptr) {
        // Beyond the cap only by rounding: every pair that this step could reach is remembered for the check.
        const double checkLimit = options_.stepCap * (1.0 + 1e-6) + kSkin;
        narrow_.gather(*contacts, leaves_, pose_.position - contacts->origin,
                       std::max(options_.rows.reach * options_.stepCap, checkLimit), checkLimit, firstSolve_);
        trust_.set(*contacts, narrow_.moved(), narrow_.farthest());
        touching_ = narrow_.smallestGap() < -proxy::kNothing;
        proxy::flagBehind(*contacts, leaves_, exempt_, clearance_);
        addPairRows(*contacts, budget);
    }
    addShapeRows(budget);
}

void Proxy::addPairRows(const ContactSet& contacts, const Budget& budget) noexcept {
    constexpr uint32_t kNone = UINT32_MAX;
    const bool anyBehind = std::any_of(contacts.behind.begin(), contacts.behind.end(),
                                       [&](const auto& flag) { return exempt_[flag.leaf] != dvec3(0.0); });
    for (ContactRow row : narrow_.rows()) {
        if (exempt_[row.leaf] != dvec3(0.0) &&
            glm::dot(row.normal, exempt_[row.leaf]) < NarrowPhase::kCosHolds) {
            continue; // would hold the leaf behind; its way out is added below
        }
        // A tool with a leaf behind has one way out. All else need only not get deeper on it: so close to the
        // sphere centres rows that ask for a way of their own ask for it to all sides, and would squeeze the
        // tool.
        row.offset = anyBehind && row.gap < 0.0 ? kSkin : offsetFor(row.gap, budget);
        addRow(row);
    }
    uint32_t last = kNone;
    for (const ContactSet::Behind& flag : contacts.behind) {
        if (flag.leaf == last || exempt_[flag.leaf] == dvec3(0.0)) {
            continue;
        }
        last = flag.leaf;
        addBehindRow(contacts, flag.leaf, budget);
    }
}

void Proxy::addBehindRow(const ContactSet& contacts, uint32_t leaf, const Budget& budget) noexcept {
    ContactRow row;
    row.kind = ContactRow::Kind::Behind;
    row.normal = exempt_[leaf];
    row.arm = leaves_[leaf] - (pose_.position - contacts.origin);
    row.leaf = leaf;
    row.gap = -clearance_[leaf];
    row.offset =
        std::max(kSkin, std::min(clearance_[leaf] + kSkin, budget.travel > kSkin ? budget.depth : 0.0));
    row.key = rowKey(row.kind, 0, leaf, 0);
    addRow(row);
}

void Proxy::addShapeRows(const Budget& budget) noexcept {
    const double limit = 2.0 * options_.stepCap;
    for (uint32_t s = 0; s < shapes_.size(); ++s) {
        const Shape& shape = shapes_[s];
        if (shape.isEquality()) {
            addEqualityRows(shape, s, budget);
            continue;
        }
        for (uint32_t leaf = 0; leaf < radius_.size(); ++leaf) {
            const dvec3 arm = pose_.rotation * places_.centre(leaf);
            std::array<SideGap, kMostSides> sides;
            const size_t count = sidesOf(shape, pose_.position + arm, radius_[leaf], sides);
            for (size_t k = 0; k < count; ++k) {
                if (sides[k].gap > limit) {
                    continue;
                }
                touching_ = touching_ || sides[k].gap < -proxy::kNothing;
                ContactRow row;
                row.kind = ContactRow::Kind::Shape;
                row.normal = sides[k].normal;
                row.arm = arm;
                row.gap = sides[k].gap;
                row.offset = offsetFor(row.gap, budget);
                row.leaf = leaf;
                row.pair = s;
                row.key = rowKey(row.kind, s, leaf, k);
                addRow(row);
            }
        }
    }
}

void Proxy::addEqualityRows(const Shape& shape, uint32_t index, const Budget& budget) noexcept {
    std::array<Equality, kMostEqualities> equalities;
    const size_t count = equalitiesOf(shape, pose_, equalities);
    for (size_t k = 0; k < count; ++k) {
        const Equality& e = equalities[k];
        const bool turning = e.linear == dvec3(0.0);
        // A turn brings the tool back no faster than new data would push it out; a rotation by what that is
        // at its rim.
        const double left = (budget.travel > kSkin ? budget.depth : 0.0) / (turning ? boundingRadius_ : 1.0);
        const double wanted = std::clamp(-e.error, -left, left);
        for (const double sign : {1.0, -1.0}) {
            ContactRow row;
            row.kind = ContactRow::Kind::Equality;
            row.normal = sign * e.linear;
            row.spin = sign * e.angular;
            row.gap = -std::abs(e.error);
            // The pair leaves a gap of rounding's size: two rows that meet exactly may seem to contradict.
            row.offset = sign * wanted - 1e-12;
            row.pair = index;
            row.key = rowKey(row.kind, index, 0, 2 * k + (sign > 0.0 ? 0 : 1));
            addRow(row);
        }
    }
}

// Every violated pair gets a row, or its row asks for more: for what the leaf's actual way, arcs of rotation
// included, falls short of the pair's tangent plane. A way that stays on the free side of that plane cannot
// enter the sphere, so one round is enough for a pair unless others push it back. share: of the solver's
// answer that was tried. False when nothing could be asked for.
bool Proxy::tighten(const Motion& tried, size_t violating, double share) noexcept {
    bool changed = false;
    const double scale = 1.0 / std::max(share, 1e-9); // the row speaks of the whole answer
    for (size_t v = 0; v < std::min(violating, violations_.size()); ++v) {
        const NarrowPhase::Violation& violation = violations_[v];
        ContactRow row = violation.row;
        const dvec3 way = next_[row.leaf] - leaves_[row.leaf];
        // Overlapping pairs without a row lie in the cone of one that has it: they need only not grow deeper.
        const double needed = kSkin - std::max(0.0, row.gap);
        size_t at = 0;
        while (at < rowCount_ &&
               !(rows_[at].kind == ContactRow::Kind::Sphere && rows_[at].pair == row.pair)) {
            ++at;
        }
        if (at < rowCount_) {
            const double shortfall = std::max(violation.depth, needed - glm::dot(row.normal, way));
            rows_[at].offset += shortfall * scale + kSkin;
            changed = true;
            continue;
        }
        const double arc = glm::dot(row.normal, tried.a + glm::cross(tried.alpha, row.arm) - way);
        row.offset = needed + std::max(0.0, arc) * scale;
        changed = addRow(row) || changed;
    }
    return changed;
}

bool Proxy::tightenShapes(double share) noexcept {
    bool changed = false;
    const double scale = 1.0 / std::max(share, 1e-9);
    for (size_t at = 0; at < rowCount_; ++at) {
        ContactRow& row = rows_[at];
        if (row.kind != ContactRow::Kind::Shape) {
            continue;
        }
        const Shape& shape = shapes_[row.pair];
        const dvec3 centre = nextPose_.position + nextPose_.rotation * places_.centre(row.leaf);
        std::array<SideGap, kMostSides> sides;
        const size_t side = static_cast<size_t>(row.key & 0xff);
        if (side >= sidesOf(shape, centre, radius_[row.leaf], sides)) {
            continue;
        }
        const double depth = std::min(0.0, row.gap) - sides[side].gap;
        if (depth > 0.0) {
            row.offset += depth * scale + kSkin;
            changed = true;
        }
    }
    return changed;
}

} // namespace fathom
