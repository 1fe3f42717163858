// SPDX-License-Identifier: Apache-2.0
// The rows of ConstrainedProxy: how they are collected, and tightened where the exact check fails.
#pragma once

#include "engine/haptics/constrained_proxy.h"

namespace fathom {

// Separated pairs: keep the leaf out, plus the skin. Overlapping pairs: move out as fast as the tick allows.
template <ProxyKinematics Kinematics>
double ConstrainedProxy<Kinematics>::offsetFor(double gap) const noexcept {
    return gap >= 0.0 ? proxy::kSkin - gap : kinematics_.escapeOffset(-gap);
}

template <ProxyKinematics Kinematics>
void ConstrainedProxy<Kinematics>::collectRows(bool first, Step& out) noexcept {
    const dvec3 centre = kinematics_.pose().position;
    rows_.clear();
    kinematics_.addLimits(rows_);
    contacts_.gather(centre, first);
    out.escape = out.escape || contacts_.overlaps();
    const bool anyBehind = contacts_.anyBehind();
    for (ContactRow row : contacts_.pairRows()) {
        if (anyBehind && contacts_.holdsBehind(row)) {
            continue; // its escape row is added below
        }
        // While a leaf is behind a surface the tool moves only towards the camera, and other pairs need only
        // not get deeper. Near the sphere centres their own normals point in all directions and would squeeze
        // the tool.
        row.offset = anyBehind && row.gap < 0.0 ? proxy::kSkin : offsetFor(row.gap);
        addRow(row);
    }
    for (ContactRow row : contacts_.behindRows(centre)) {
        row.offset = kinematics_.escapeOffset(-row.gap);
        addRow(row);
    }
    if (!anyBehind) {
        addSmoothRows();
    }
    addShapeRows(out);
}

// A leaf inside of its plane, because that turned as the leaf slid, may stay: only spheres push a tool out.
template <ProxyKinematics Kinematics>
void ConstrainedProxy<Kinematics>::addSmoothRows() noexcept {
    for (ContactRow row : contacts_.smoothRows()) {
        row.offset = std::min(0.0, -row.gap);
        addRow(row);
    }
}

template <ProxyKinematics Kinematics>
void ConstrainedProxy<Kinematics>::findNearShapes() noexcept {
    nearShapes_.clear();
    const double reach = 2.0 * options_.stepCap + proxy::kSkin;
    const Sphere bound = kinematics_.bound();
    for (uint32_t s = 0; s < shapes().size(); ++s) {
        const Shape& shape = shapes()[s];
        if (shape.isEquality() || gapTo(shape, bound.centre, bound.radius).gap > reach) {
            continue; // no leaf is nearer than the sphere around all
        }
        for (uint32_t leaf = 0; leaf < contacts_.leafCount(); ++leaf) {
            if (!contacts_.holds(s, leaf)) {
                continue;
            }
            const double gap =
                gapTo(shape, kinematics_.leafNow(leaf, contacts_.leaves), contacts_.radius(leaf)).gap;
            if (gap <= reach) {
                nearShapes_.add(s, leaf, gap);
            }
        }
    }
}

// Where the solver has no room for all leaves near a shape, tightenShapes() adds rows for others that turn
// out to be in the way.
template <ProxyKinematics Kinematics>
void ConstrainedProxy<Kinematics>::addShapeRows(Step& out) noexcept {
    findNearShapes();
    const size_t taken = rows_.size() + proxy::kSpareRows;
    everyShapeRow_ = nearShapes_.select(proxy::kMaxRows - std::min(taken, proxy::kMaxRows));
    size_t next = 0;
    for (uint32_t s = 0; s < shapes().size(); ++s) {
        if (shapes()[s].isEquality()) {
            addEqualityRows(shapes()[s], s);
        }
        for (; next < nearShapes_.pairs().size() && nearShapes_.pairs()[next].shape == s; ++next) {
            NearShapes::Pair& pair = nearShapes_.pairs()[next];
            out.escape = out.escape || pair.gap < -proxy::kNegligible;
            pair.row = pair.row && addShapeRows(s, pair.leaf);
            everyShapeRow_ = everyShapeRow_ && pair.row;
        }
    }
}

// False when there is no room for all sides.
template <ProxyKinematics Kinematics>
bool ConstrainedProxy<Kinematics>::addShapeRows(uint32_t shape, uint32_t leaf) noexcept {
    std::array<SideGap, kMaxSides> sides;
    const size_t count =
        sidesOf(shapes()[shape], kinematics_.leafNow(leaf, contacts_.leaves), contacts_.radius(leaf), sides);
    bool room = true;
    for (size_t k = 0; k < count; ++k) {
        room = (sides[k].gap > 2.0 * options_.stepCap || addRow(shapeRow(shape, leaf, k, sides[k]))) && room;
    }
    return room;
}

template <ProxyKinematics Kinematics>
ContactRow ConstrainedProxy<Kinematics>::shapeRow(uint32_t shape, uint32_t leaf, size_t side,
                                                  const SideGap& gap) const noexcept {
    ContactRow row;
    row.kind = ContactRow::Kind::Shape;
    row.normal = gap.normal;
    row.arm = kinematics_.lever(leaf, kinematics_.leafNow(leaf, contacts_.leaves));
    row.gap = gap.gap;
    row.offset = offsetFor(row.gap);
    row.leaf = leaf;
    row.pair = shape;
    row.key = rowKey(row.kind, shape, leaf, side);
    return row;
}

// Lines and axes constrain the tool or tip by two opposite rows per equation. They pull it back no faster
// than new data would push it out.
template <ProxyKinematics Kinematics>
void ConstrainedProxy<Kinematics>::addEqualityRows(const Shape& shape, uint32_t index) noexcept {
    std::array<Equality, kMaxEqualities> equalities;
    const size_t count = equalitiesOf(shape, kinematics_.pose(), equalities);
    for (size_t k = 0; k < count; ++k) {
        const Equality& e = equalities[k];
        const double limit = kinematics_.equalityLimit(e);
        const double wanted = std::clamp(-e.error, -limit, limit);
        for (const double sign : {1.0, -1.0}) {
            ContactRow row;
            row.kind = ContactRow::Kind::Equality;
            row.normal = sign * e.linear;
            row.spin = sign * e.angular;
            row.gap = -std::abs(e.error);
            // Relaxed by a rounding error, because two rows that meet exactly may appear contradictory.
            row.offset = sign * wanted - 1e-12;
            row.pair = index;
            row.key = rowKey(row.kind, index, 0, 2 * k + (sign > 0.0 ? 0 : 1));
            addRow(row);
        }
    }
}

// Adds a row for every violated pair or raises its offset, by as much as the leaf's actual path (rotation
// arcs included) falls short of the pair's tangent plane. A path on the free side of that plane cannot enter
// the sphere, so one round is enough for a pair unless others push it back. Sides of shapes and equations are
// treated alike. False when no row could be tightened.
template <ProxyKinematics Kinematics>
bool ConstrainedProxy<Kinematics>::tighten(const Answer& answer) noexcept {
    const double tried = kinematics_.triedFraction(answer);
    bool changed = false;
    for (const NarrowPhase::Violation& violation : contacts_.violations()) {
        ContactRow row = violation.row;
        // Overlapping pairs without a row are in the cone of a pair that has one: they need only not get
        // deeper.
        const double needed = proxy::kSkin - std::max(0.0, row.gap);
        if (ContactRow* known = rows_.ofPair(row.pair)) {
            const double amount = kinematics_.shortfall(violation, needed, contacts_.leaves);
            known->offset = kinematics_.raised(known->offset, amount, tried);
            changed = true;
        } else {
            row.offset = needed + kinematics_.arcOf(answer, row, contacts_.leaves);
            changed = addRow(row) || changed;
        }
    }
    const bool shapesChanged = tightenShapes(tried);
    return kinematics_.tightenEqualities(shapes(), tried, rows_) || shapesChanged || changed;
}

template <ProxyKinematics Kinematics>
bool ConstrainedProxy<Kinematics>::tightenShapes(double tried) noexcept {
    bool changed = false;
    for (size_t i = 0; i < rows_.size(); ++i) {
        ContactRow& row = rows_[i];
        if (row.kind != ContactRow::Kind::Shape) {
            continue;
        }
        std::array<SideGap, kMaxSides> sides;
        const size_t side = static_cast<size_t>(row.key & 0xff);
        const dvec3 centre = kinematics_.leafNext(row.leaf, contacts_.leaves);
        if (side >= sidesOf(shapes()[row.pair], centre, contacts_.radius(row.leaf), sides)) {
            continue;
        }
        const double depth = std::min(0.0, row.gap) - sides[side].gap;
        if (depth > 0.0) {
            row.offset = kinematics_.raised(row.offset, depth, tried);
            changed = true;
        }
    }
    return (!everyShapeRow_ && addMissingShapeRow()) || changed;
}

// A row for the leaf that gets deepest into a shape without having one.
template <ProxyKinematics Kinematics>
bool ConstrainedProxy<Kinematics>::addMissingShapeRow() noexcept {
    std::array<SideGap, kMaxSides> now, next;
    double deepest = 0.0;
    NearShapes::Pair* missing = nullptr;
    for (NearShapes::Pair& pair : nearShapes_.pairs()) {
        if (pair.row) {
            continue;
        }
        const Shape& shape = shapes()[pair.shape];
        const double radius = contacts_.radius(pair.leaf);
        const size_t count =
            std::min(sidesOf(shape, kinematics_.leafNow(pair.leaf, contacts_.leaves), radius, now),
                     sidesOf(shape, kinematics_.leafNext(pair.leaf, contacts_.leaves), radius, next));
        for (size_t k = 0; k < count; ++k) {
            const double depth = std::min(0.0, now[k].gap) - next[k].gap;
            if (depth > deepest) {
                deepest = depth;
                missing = &pair;
            }
        }
    }
    if (missing == nullptr) {
        return false;
    }
    missing->row = true;
    return addShapeRows(missing->shape, missing->leaf);
}

} // namespace fathom
