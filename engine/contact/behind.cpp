// SPDX-License-Identifier: Apache-2.0
#include "engine/contact/behind.h"

#include <cmath>

namespace fathom {

namespace {

constexpr double kSigmas = 3.0;
constexpr double kNearest = 1e-6; // [m] before the camera; nearer points have no pixel

} // namespace

BehindTracker::Sight BehindTracker::look(const Fixtures& fixtures, const Pose& cameraTbase,
                                         const dvec3& point) {
    Sight sight;
    const Intrinsics& lens = fixtures.camera.depth;
    const dvec3 p = cameraTbase.apply(point);
    if (fixtures.depth.size() < static_cast<size_t>(lens.pixels()) || !(p.z > kNearest)) {
        return sight;
    }
    const glm::dvec2 pixel = lens.project(p);
    const double u = std::floor(pixel.x + 0.5), v = std::floor(pixel.y + 0.5);
    if (!(u >= 0.0 && v >= 0.0 && u < lens.width && v < lens.height)) {
        return sight;
    }
    const uint32_t column = static_cast<uint32_t>(u), line = static_cast<uint32_t>(v);
    const uint16_t raw = fixtures.depth[static_cast<size_t>(line) * lens.width + column];
    if (raw == 0) {
        return sight;
    }
    const double z = raw * fixtures.camera.metresPerUnit;
    sight.known = true;
    sight.forbidden = fixtures.forbiddenAt(column, line);
    sight.before = z - p.z;
    sight.sigma = depthSigma(z);
    sight.range = glm::length(p) * z / p.z;
    return sight;
}

bool BehindTracker::becameBehind(const Sight& sight, double resting) {
    const double margin = kSigmas * sight.sigma;
    return sight.known && sight.forbidden &&
           (resting > 2.0 * margin ? sight.before < margin : sight.before < -margin);
}

// resting: R + r [m]; ownRange: from the camera to the leaf's centre [m].
void BehindTracker::follow(Leaf& leaf, const Sight& sight, double resting, double ownRange, bool newSet) {
    if (newSet) {
        leaf.inFrontBefore = leaf.inFront;
    }
    const double margin = kSigmas * sight.sigma;
    if (leaf.behind) {
        if (sight.known && sight.forbidden) {
            leaf.range = sight.range; // the surface moves on: so does the way that is left
        } else if (sight.known && sight.before > margin) {
            leaf.behind = false; // seen in the open
        }
        if (ownRange <= leaf.range - resting) {
            leaf.behind = false;
        }
    } else if (newSet && leaf.inFrontBefore && becameBehind(sight, resting)) {
        leaf.behind = true;
        leaf.range = sight.range;
    }
    leaf.inFront = !leaf.behind && sight.known && sight.forbidden && sight.before > -margin;
}

void BehindTracker::update(const Tool& tool, const Fixtures& fixtures, double regionRadius, ContactSet& set) {
    leaves_.resize(tool.leafCount());
    const bool newSet = any_ && fixtures.generation != generation_;
    any_ = true;
    generation_ = fixtures.generation;
    set.behind.clear();
    const Pose cameraTbase = inverse(fixtures.baseTcamera);
    for (uint32_t i = 0; i < leaves_.size(); ++i) {
        const dvec3 centre = set.origin + set.leafAtQuery[i];
        const dvec3 toCamera = fixtures.baseTcamera.position - centre;
        const double ownRange = glm::length(toCamera);
        const double resting = regionRadius + tool.leaves()[i].radius;
        follow(leaves_[i], look(fixtures, cameraTbase, centre), resting, ownRange, newSet);
        if (leaves_[i].behind && ownRange > kNearest) {
            set.behind.push_back({i, toCamera / ownRange, ownRange - leaves_[i].range + resting});
        }
    }
}

} // namespace fathom
