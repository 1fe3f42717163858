// SPDX-License-Identifier: Apache-2.0
#include "engine/contact/behind.h"

#include "engine/contact/pair_gaps.h"

#include <algorithm>
#include <cmath>

namespace fathom {

namespace {

constexpr double kSigmas = 3.0;
constexpr double kDeep = 0.25;    // of R + r: only new data can bring a leaf nearer to the surface
constexpr double kNearest = 1e-6; // [m] from the camera; nearer points have no pixel
constexpr double kMostJump = 0.1; // [m] beyond R + r, of a surface between two sets: 3 m/s at 30 Hz

// Deepest overlap of the leaf with any listed sphere [m]; 0 when it is clear of all.
double overlapOf(const ContactSet& set, uint32_t leaf, double radius) {
    double deepest = 0.0;
    const SphereSpan run = pairsOf(set, set.pairBegin[leaf], set.pairsUpTo(leaf, 0.0));
    for (size_t k = 0; k < run.count; ++k) {
        deepest = std::max(deepest, -gapOf(run, k, {set.leafAtQuery[leaf], radius}));
    }
    return deepest;
}

// Whether a listed sphere is less than `before` [m] behind the leaf's centre, seen from the camera.
bool hasSphere(const ContactSet& set, uint32_t leaf, const dvec3& towardsCamera, double before) {
    const SphereSpan run = pairsOf(set, set.pairBegin[leaf], set.pairBegin[leaf + 1]);
    for (size_t k = 0; k < run.count; ++k) {
        if (glm::dot(awayFrom(run, k, set.leafAtQuery[leaf]), towardsCamera) < before) {
            return true;
        }
    }
    return false;
}

// Whether at least half of the pixels around a point [m, camera frame] show a surface nearer than z [m]: more
// than marine snow.
bool hasExtent(const HostFixtures& fixtures, const dvec3& point, double z) {
    const Intrinsics& lens = fixtures.camera.depth;
    const glm::dvec2 pixel = glm::floor(lens.project(point) + 0.5);
    int near = 0;
    for (double v = std::max(0.0, pixel.y - 1.0); v <= pixel.y + 1.0 && v < lens.height; ++v) {
        for (double u = std::max(0.0, pixel.x - 1.0); u <= pixel.x + 1.0 && u < lens.width; ++u) {
            const uint16_t raw = fixtures.depth[static_cast<size_t>(v) * lens.width + static_cast<size_t>(u)];
            near += raw != 0 && raw * fixtures.camera.metresPerUnit < z ? 1 : 0;
        }
    }
    return near >= 5;
}

} // namespace

BehindTracker::DepthSample BehindTracker::sampleAt(const HostFixtures& fixtures, const PatchBits* bits,
                                                   const Pose& cameraTbase, const dvec3& point) {
    DepthSample sample;
    const Intrinsics& lens = fixtures.camera.depth;
    const dvec3 p = cameraTbase.apply(point);
    if (fixtures.depth.size() < static_cast<size_t>(lens.pixels()) || !(p.z > kNearest)) {
        return sample;
    }
    const glm::dvec2 pixel = lens.project(p);
    const double u = std::floor(pixel.x + 0.5), v = std::floor(pixel.y + 0.5);
    if (!(u >= 0.0 && v >= 0.0 && u < lens.width && v < lens.height)) {
        return sample;
    }
    const uint32_t column = static_cast<uint32_t>(u), line = static_cast<uint32_t>(v);
    const uint16_t raw = fixtures.depth[static_cast<size_t>(line) * lens.width + column];
    if (raw == 0) {
        return sample;
    }
    const double z = raw * fixtures.camera.metresPerUnit;
    sample.known = true;
    sample.forbidden = bits != nullptr ? bits->at(column, line) : fixtures.forbiddenAt(column, line);
    sample.before = z - p.z;
    sample.z = z;
    sample.point = p;
    return sample;
}

double BehindTracker::DepthSample::margin(const CameraInfo& camera) const {
    return kSigmas * camera.sigmaAt(point * (z / point.z));
}

BehindTracker::LeafPlace BehindTracker::placeOf(const ContactSet& set, uint32_t leaf, double radius,
                                                double regionRadius) {
    LeafPlace place;
    place.toCamera = set.camera - set.leafAtQuery[leaf];
    place.range = glm::length(place.toCamera);
    place.resting = regionRadius + radius;
    place.nearer = place.resting + set.reach;
    place.overlap = overlapOf(set, leaf, radius);
    return place;
}

bool BehindTracker::becameBehind(const HostFixtures& fixtures, const DepthSample& sample,
                                 const LeafPlace& place, const Leaf& leaf, uint32_t index,
                                 const ContactSet& set) {
    const double margin = sample.margin(fixtures.camera);
    const double before = place.resting > 2.0 * margin ? std::max(margin, kDeep * place.resting) : -margin;
    if (!(sample.before < before)) {
        return false;
    }
    const bool near = place.range - sample.range() <= place.nearer &&
                      hasSphere(set, index, place.toCamera / place.range, before);
    return near || (leaf.range - sample.z <= place.resting + kMostJump &&
                    hasExtent(fixtures, sample.point, sample.point.z + before));
}

// Of a leaf that is behind.
void BehindTracker::follow(const HostFixtures& fixtures, const DepthSample& sample, const LeafPlace& place,
                           Leaf& leaf) {
    const bool surface = sample.known && sample.forbidden;
    const double nearer = surface ? leaf.range - sample.range() : 0.0;
    if (surface && (nearer <= place.nearer || (nearer <= place.resting + kMostJump &&
                                               hasExtent(fixtures, sample.point, sample.point.z)))) {
        leaf.range = sample.range(); // the surface may have moved
    } else if (sample.known && !surface && sample.before > sample.margin(fixtures.camera)) {
        leaf.behind = false; // the view to it is free
    }
    if (place.range <= leaf.range - place.resting && place.overlap <= 0.0) {
        leaf.behind = false;
    }
}

void BehindTracker::update(const Tool& tool, const HostFixtures& fixtures, double regionRadius,
                           ContactSet& set, const PatchBits* bits) {
    leaves_.resize(tool.leafCount());
    const bool newSet = any_ && fixtures.generation != generation_;
    any_ = true;
    generation_ = fixtures.generation;
    set.behind.clear();
    const Pose cameraTbase = inverse(fixtures.baseTcamera);
    for (uint32_t i = 0; i < leaves_.size(); ++i) {
        Leaf& leaf = leaves_[i];
        const DepthSample sample = sampleAt(fixtures, bits, cameraTbase, set.origin + set.leafAtQuery[i]);
        const bool surface = sample.known && sample.forbidden;
        if (leaf.behind || (newSet && leaf.inFront && surface)) {
            const LeafPlace place = placeOf(set, i, tool.leaves()[i].radius, regionRadius);
            if (leaf.behind) {
                follow(fixtures, sample, place, leaf);
            } else if (becameBehind(fixtures, sample, place, leaf, i, set)) {
                leaf.behind = true;
                leaf.range = sample.range();
            }
            if (leaf.behind && place.range > kNearest) {
                const double left = place.range - leaf.range + place.resting;
                set.behind.push_back({i, place.toCamera / place.range, std::max(left, place.overlap)});
            }
        }
        leaf.inFront = !leaf.behind && surface &&
                       (sample.before > 0.0 || sample.before > -sample.margin(fixtures.camera));
        leaf.range = leaf.behind ? leaf.range : sample.z;
    }
}

} // namespace fathom
