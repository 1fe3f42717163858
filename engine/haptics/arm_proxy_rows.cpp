// SPDX-License-Identifier: Apache-2.0
// The conditions on the next joint increments at the present posture: region spheres, leaves behind a
// surface, authored shapes, joint limits and speeds.
#include "engine/haptics/arm_proxy.h"

#include "engine/haptics/proxy_limits.h"
#include "engine/haptics/row_rules.h"

#include <algorithm>
#include <cmath>

namespace fathom {

namespace {

using proxy::kSkin;
using proxy::rowKey;

} // namespace

double ArmProxy::clampedJoint(size_t k, double q) const noexcept {
    const double reach = arm_.joints[k].speed * options_.period;
    return std::clamp(q, std::max(arm_.joints[k].lower, start_[k] - reach),
                      std::min(arm_.joints[k].upper, start_[k] + reach));
}

void ArmProxy::addRow(const JointVector& normal, double offset, const SolverRow& what) noexcept {
    const size_t at = solver_.rows();
    if (solver_.addRow(std::span(normal.data(), n_), offset)) {
        solver_.setKey(at, what.row.key);
        rows_[at] = what;
    }
}

void ArmProxy::addLeafRow(const ContactRow& row, double offset) noexcept {
    const ArmLeaf& leaf = arm_.leaves[row.leaf];
    const dvec3 centre = leaves_[row.leaf] + origin_;
    JointVector normal{};
    for (size_t k = 0; k < leaf.joint; ++k) {
        normal[k] = glm::dot(row.normal, arm_.motionOf(frames_, k, centre));
    }
    // No more than half of what the joints can do in what is left of the turn.
    double possible = 0.0;
    for (size_t k = 0; k < leaf.joint && offset > proxy::kEscapeThreshold; ++k) {
        const double low = clampedJoint(k, -1e9) - q_[k], high = clampedJoint(k, 1e9) - q_[k];
        possible += std::max(normal[k] * low, normal[k] * high);
    }
    offset = offset > proxy::kEscapeThreshold ? std::min(offset, 0.5 * possible) : offset;
    addRow(normal, offset, {row, false});
}

// Limits of place and of speed, whichever is nearer, about the present joints.
void ArmProxy::addJointRows() noexcept {
    for (size_t k = 0; k < n_; ++k) {
        const double reach = arm_.joints[k].speed * options_.period;
        const double low = std::max(arm_.joints[k].lower, start_[k] - reach) - q_[k];
        const double high = std::min(arm_.joints[k].upper, start_[k] + reach) - q_[k];
        for (const double sign : {1.0, -1.0}) {
            JointVector normal{};
            normal[k] = sign;
            SolverRow what;
            what.joint = true;
            what.row.key = ~uint64_t{0} - 2 * k - (sign > 0.0 ? 1 : 0);
            addRow(normal, std::min(0.0, sign > 0.0 ? low : -high), what);
        }
    }
}

void ArmProxy::gather(const ContactSet& contacts, bool anew) noexcept {
    const double checkLimit = options_.stepCap * (1.0 + 1e-6) + kSkin;
    narrow_.gather(contacts, leaves_, tip().position - contacts.origin, 2.0 * options_.stepCap, checkLimit,
                   anew);
    trust_.set(contacts, narrow_.moved(), narrow_.farthest());
}

void ArmProxy::collectRows(const ContactSet* contacts, bool anew, ArmStep& out) noexcept {
    solver_.clearRows();
    addJointRows();
    if (contacts != nullptr) {
        gather(*contacts, anew);
        out.escape = out.escape || narrow_.smallestGap() < -proxy::kNothing;
        proxy::flagBehind(*contacts, leaves_, exempt_, clearance_);
        addPairRows(*contacts);
        addBehindRows(*contacts);
    }
    addShapeRows(out);
}

void ArmProxy::addPairRows(const ContactSet& contacts) noexcept {
    const bool anyBehind = std::any_of(contacts.behind.begin(), contacts.behind.end(),
                                       [&](const auto& flag) { return exempt_[flag.leaf] != dvec3(0.0); });
    for (const ContactRow& row : narrow_.rows()) {
        if (exempt_[row.leaf] != dvec3(0.0) &&
            glm::dot(row.normal, exempt_[row.leaf]) < NarrowPhase::kCosHolds) {
            continue; // would hold the leaf behind
        }
        // An arm with a leaf behind has one way out; all else need only not get deeper on it.
        const double asked = row.gap >= 0.0 ? -row.gap : anyBehind ? 0.0 : std::min(-row.gap, escapeLeft_);
        addLeafRow(row, asked + kSkin);
    }
}

void ArmProxy::addBehindRows(const ContactSet& contacts) noexcept {
    uint32_t last = ~0u;
    for (const ContactSet::Behind& flag : contacts.behind) {
        if (flag.leaf == last || exempt_[flag.leaf] == dvec3(0.0)) {
            continue;
        }
        last = flag.leaf;
        ContactRow row;
        row.kind = ContactRow::Kind::Behind;
        row.normal = exempt_[flag.leaf];
        row.arm = leaves_[flag.leaf] + origin_ - tip().position;
        row.leaf = flag.leaf;
        row.gap = -clearance_[flag.leaf];
        row.key = rowKey(row.kind, 0, flag.leaf, 0);
        addLeafRow(row, std::min(clearance_[flag.leaf], escapeLeft_) + kSkin);
    }
}

void ArmProxy::addShapeRows(ArmStep& out) noexcept {
    for (uint32_t s = 0; s < shapes_.size(); ++s) {
        const Shape& shape = shapes_[s];
        if (shape.isEquality()) {
            addEqualityRows(shape, s);
            continue;
        }
        for (uint32_t leaf = 0; leaf < arm_.leaves.size(); ++leaf) {
            std::array<SideGap, kMostSides> sides;
            const dvec3 centre = leaves_[leaf] + origin_;
            const size_t count = sidesOf(shape, centre, arm_.leaves[leaf].sphere.radius, sides);
            for (size_t k = 0; k < count; ++k) {
                if (sides[k].gap > 2.0 * options_.stepCap) {
                    continue;
                }
                out.escape = out.escape || sides[k].gap < -proxy::kNothing;
                ContactRow row;
                row.kind = ContactRow::Kind::Shape;
                row.normal = sides[k].normal;
                row.arm = centre - tip().position;
                row.gap = sides[k].gap;
                row.leaf = leaf;
                row.pair = s;
                row.key = rowKey(row.kind, s, leaf, k);
                addLeafRow(row, (row.gap < 0.0 ? std::min(-row.gap, escapeLeft_) : -row.gap) + kSkin);
            }
        }
    }
}

// Lines and axes bind the tip; a turn brings it back no faster than new data would push it.
void ArmProxy::addEqualityRows(const Shape& shape, uint32_t index) noexcept {
    std::array<Equality, kMostEqualities> equalities;
    const Pose now = tip();
    const size_t count = equalitiesOf(shape, now, equalities);
    for (size_t k = 0; k < count; ++k) {
        const Equality& e = equalities[k];
        JointVector along{};
        for (size_t j = 0; j < n_; ++j) {
            const dvec3 turning = arm_.joints[j].slides ? dvec3(0.0) : arm_.axisOf(frames_, j);
            along[j] =
                glm::dot(e.linear, arm_.motionOf(frames_, j, now.position)) + glm::dot(e.angular, turning);
        }
        const double wanted = std::clamp(-e.error, -escapeLeft_, escapeLeft_);
        for (const double sign : {1.0, -1.0}) {
            JointVector normal{};
            for (size_t j = 0; j < n_; ++j) {
                normal[j] = sign * along[j];
            }
            ContactRow row;
            row.kind = ContactRow::Kind::Equality;
            row.normal = sign * e.linear;
            row.spin = sign * e.angular;
            row.gap = -std::abs(e.error);
            row.pair = index;
            row.key = rowKey(row.kind, index, 0, 2 * k + (sign > 0.0 ? 0 : 1));
            addRow(normal, sign * wanted - 1e-12, {row, false}); // less: rounding must not make two meet
        }
    }
}

// Asks more of the pairs that a motion took in too deep. False when nothing could be asked for.
bool ArmProxy::tighten(size_t violating, double share) noexcept {
    const size_t before = solver_.rows();
    bool changed = false;
    for (size_t v = 0; v < std::min(violating, violations_.size()); ++v) {
        const NarrowPhase::Violation& violation = violations_[v];
        const auto same = [&](const SolverRow& r) {
            return !r.joint && r.row.kind == ContactRow::Kind::Sphere && r.row.pair == violation.row.pair;
        };
        const auto end = rows_.begin() + static_cast<std::ptrdiff_t>(before);
        const auto found = std::find_if(rows_.begin(), end, same);
        if (found != end) {
            const auto at = static_cast<size_t>(found - rows_.begin());
            solver_.setOffset(at, solver_.offset(at) + violation.depth / std::max(share, 1e-6) + kSkin);
        } else {
            addLeafRow(violation.row, -std::max(0.0, violation.row.gap) + kSkin);
        }
        changed = true;
    }
    return changed;
}

bool ArmProxy::tightenShapes(double share) noexcept {
    bool changed = false;
    for (size_t at = 0; at < solver_.rows(); ++at) {
        const ContactRow& row = rows_[at].row;
        if (rows_[at].joint || row.kind != ContactRow::Kind::Shape) {
            continue;
        }
        std::array<SideGap, kMostSides> sides;
        const size_t side = static_cast<size_t>(row.key & 0xff);
        if (side >= sidesOf(shapes_[row.pair], nextLeaves_[row.leaf] + origin_,
                            arm_.leaves[row.leaf].sphere.radius, sides)) {
            continue;
        }
        const double depth = std::min(0.0, row.gap) - sides[side].gap;
        if (depth > 0.0) {
            solver_.setOffset(at, solver_.offset(at) + depth / std::max(share, 1e-6) + kSkin);
            changed = true;
        }
    }
    return changed;
}

// The arcs that joints go on carry the tip off a line by more than its rows can tell: what they were wrong by
// is asked for the other way.
bool ArmProxy::tightenEqualities(double share) noexcept {
    bool changed = false;
    for (size_t at = 0; at < solver_.rows(); ++at) {
        const ContactRow& row = rows_[at].row;
        if (rows_[at].joint || row.kind != ContactRow::Kind::Equality) {
            continue;
        }
        const size_t k = static_cast<size_t>(row.key & 0xff) / 2;
        std::array<Equality, kMostEqualities> before, after;
        equalitiesOf(shapes_[row.pair], arm_.tip(frames_), before);
        if (k >= equalitiesOf(shapes_[row.pair], arm_.tip(nextFrames_), after)) {
            continue;
        }
        const double sign = (row.key & 1) == 0 ? 1.0 : -1.0;
        const double limit = std::clamp(-before[k].error, -escapeLeft_, escapeLeft_);
        const double wrong = after[k].error - (before[k].error + share * limit);
        if (std::abs(wrong) > 1e-13) {
            solver_.setOffset(at, solver_.offset(at) - sign * wrong / std::max(share, 1e-6));
            changed = true;
        }
    }
    return changed;
}

void ArmProxy::recordActive(ArmStep& out) noexcept {
    out.contacts = out.atLimits = 0;
    activeCount_ = 0;
    const auto multipliers = solver_.multipliers();
    for (size_t i = 0; i < multipliers.size(); ++i) {
        if (!(multipliers[i] > 0.0)) {
            continue;
        }
        ++(rows_[i].joint ? out.atLimits : out.contacts);
        if (!rows_[i].joint && activeCount_ < active_.size()) {
            active_[activeCount_++] = {rows_[i].row, multipliers[i]};
        }
    }
}

} // namespace fathom
