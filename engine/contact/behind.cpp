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

// Deepest overlap of the leaf with any listed sphere [m]; 0 when it is clear of all.
double overlapOf(const ContactSet& set, uint32_t leaf, double radius) {
    double deepest = 0.0;
    if (set.pairBegin.size() <= leaf + 1 || set.pairBegin[leaf] == set.pairBegin[leaf + 1]) {
        return deepest;
    }
    const PairArrays run = pairsOf(set, set.pairBegin[leaf], set.pairsUpTo(leaf, 0.0));
    for (size_t k = 0; k < run.count; ++k) {
        deepest = std::max(deepest, -gapOf(run, k, set.leafAtQuery[leaf], radius));
    }
    return deepest;
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
    sample.sigma = fixtures.camera.sigmaAt(p * (z / p.z));
    sample.range = glm::length(p) * z / p.z;
    return sample;
}

bool BehindTracker::becameBehind(const DepthSample& sample, double resting) {
    const double margin = kSigmas * sample.sigma;
    const double inFront = resting > 2.0 * margin ? std::max(margin, kDeep * resting) : -margin;
    return sample.known && sample.forbidden && sample.before < inFront;
}

void BehindTracker::follow(Leaf& leaf, const DepthSample& sample, const LeafDistance& distance, bool newSet) {
    if (newSet) {
        leaf.inFrontBefore = leaf.inFront;
    }
    const double margin = kSigmas * sample.sigma;
    if (leaf.behind) {
        if (sample.known && sample.forbidden) {
            leaf.range = sample.range; // the surface may have moved
        } else if (sample.known && sample.before > margin) {
            leaf.behind = false; // the view to it is free
        }
        if (distance.range <= leaf.range - distance.resting && distance.overlap <= 0.0) {
            leaf.behind = false;
        }
    } else if (newSet && leaf.inFrontBefore && becameBehind(sample, distance.resting)) {
        leaf.behind = true;
        leaf.range = sample.range;
    }
    leaf.inFront = !leaf.behind && sample.known && sample.forbidden && sample.before > -margin;
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
        const dvec3 centre = set.origin + set.leafAtQuery[i];
        const dvec3 toCamera = fixtures.baseTcamera.position - centre;
        const double ownRange = glm::length(toCamera);
        LeafDistance distance{regionRadius + tool.leaves()[i].radius, ownRange, 0.0};
        distance.overlap = leaves_[i].behind ? overlapOf(set, i, tool.leaves()[i].radius) : 0.0;
        follow(leaves_[i], sampleAt(fixtures, bits, cameraTbase, centre), distance, newSet);
        if (leaves_[i].behind && ownRange > kNearest) {
            const double left = ownRange - leaves_[i].range + distance.resting;
            set.behind.push_back({i, toCamera / ownRange, std::max(left, distance.overlap)});
        }
    }
}

} // namespace fathom
