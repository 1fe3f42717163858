// SPDX-License-Identifier: Apache-2.0
// A motion of the tool, the resulting leaf centres, and the share of it within the trust region.
#pragma once

#include "engine/contact/contact_set.h"
#include "engine/contact/leaf_centres.h"
#include "engine/contact/tool.h"

#include <vector>

namespace fathom {

// [a; alpha]: translation [m] and rotation vector [rad] about the tool's centre, base axes.
struct Motion {
    dvec3 a{0.0}, alpha{0.0};
};

// Componentwise.
inline Motion operator+(const Motion& m, const Motion& o) {
    return {m.a + o.a, m.alpha + o.alpha};
}
inline Motion operator-(const Motion& m, const Motion& o) {
    return {m.a - o.a, m.alpha - o.alpha};
}
// Componentwise.
inline Motion operator*(double s, const Motion& m) {
    return {s * m.a, s * m.alpha};
}

// The pose after the step; the quaternion is normalised.
Pose moved(const Pose& pose, const Motion& motion) noexcept;

// Remaining motion from pose to target: [p_target - p; log(q_target q^-1)], shortest arc.
Motion remaining(const Pose& pose, const Pose& target) noexcept;

// Inner product [m^2] of the metric: a . b of the translations plus k^2 times that of the rotations.
double productOf(const Motion& a, const Motion& b, double k) noexcept;
// sqrt(|a|^2 + k^2 |alpha|^2) [m]; 0 where that is no number.
double lengthOf(const Motion& motion, double k) noexcept;
// The same, but never 0, to divide by.
double divisorOf(const Motion& motion, double k) noexcept;

// Points [first, first + count) of one frame at its pose, about `origin` [m].
void placePoints(const LeafCentres& points, size_t first, size_t count, const Pose& pose, const dvec3& origin,
                 LeafCentres& out) noexcept;

// Leaf centres of a tool at poses. noexcept and without allocation after the constructor; one thread.
class LeafPlaces {
public:
    explicit LeafPlaces(const Tool& tool);

    // Leaf centres about `origin` [m].
    void place(const Pose& pose, const dvec3& origin, LeafCentres& out) const noexcept;

    // Bounds on how far any leaf centre travels [m]: max |a| + |alpha x r|, and a coarser one that does not
    // depend on single leaves.
    double travelBound(const Pose& pose, const Motion& motion) const noexcept;
    double crudeBound(const Motion& motion) const noexcept {
        return glm::length(motion.a) + glm::length(motion.alpha) * farthest_;
    }

    size_t count() const { return centres_.size(); }
    dvec3 centre(size_t leaf) const { return centres_[leaf]; } // tool frame [m]

private:
    LeafCentres centres_;   // tool frame [m]
    double farthest_ = 0.0; // [m] largest distance of a centre from the tool's
};

// Trust region: no leaf may end farther from its position at the query than the reach less kMargin,
// or than it already is. Within it no unlisted pair can touch.
class TrustRegion {
public:
    static constexpr double kMargin = 1e-5; // [m]

    explicit TrustRegion(size_t leaves)
        : bound_(leaves, 0.0) {}

    // Sets the bounds for a step from the present leaf positions.
    void set(const ContactSet& contacts, const LeafCentres& leaves) noexcept;

    bool contains(const ContactSet& contacts, const LeafCentres& next) const noexcept;
    // True only if contains() holds for every step whose leaves travel at most `travel` [m].
    bool surelyContains(double travel) const noexcept { return travel <= room_; }
    // Largest share of the straight paths from -> next that stays inside, 0..1.
    double share(const ContactSet& contacts, const LeafCentres& from, const LeafCentres& next) const noexcept;

    // True when the set is usable with the leaves there: no leaf outside its reach.
    static bool allows(const ContactSet& contacts, const LeafCentres& leaves) noexcept;

private:
    double boundOf(size_t leaf) const noexcept { return beyond_ ? bound_[leaf] : limit_; }

    std::vector<double> bound_; // [m] per leaf, while some leaf is beyond the limit
    double limit_ = 0.0;        // [m] bound of every leaf that is not beyond it already
    double room_ = 0.0;         // [m] that every leaf may travel in any direction; < 0: some leaf is beyond
    bool beyond_ = false;
};

} // namespace fathom
