// SPDX-License-Identifier: Apache-2.0
// Settles the targets of guidance over frames, in the base frame. Noise, colours that flicker, and a camera
// that sees a little more of one side move the mean of a class; its target should rest.
#pragma once

#include "engine/contact/host_fixtures.h"
#include "engine/scene/scene.h"

#include <map>
#include <span>

namespace fathom::cloud {

// A vector measured once per frame: its mean over up to 300 frames. The mean stays within `gate` of the last
// few measurements, so real motion is followed with that lag. What is shown follows the mean with play.
class SteadyVector {
public:
    SteadyVector(double gate, double play)
        : gate_(gate)
        , play_(play) {}

    const dvec3& step(const dvec3& measured) noexcept;

private:
    double gate_, play_;
    dvec3 mean_{0.0}, recent_{0.0}, shown_{0.0}; // recent_: of the last frames, relative to the mean
    double count_ = 0.0;                         // [frames] in the mean
};

// Frame thread only.
class GuidanceEstimates {
public:
    // Call once per set, in order. camera [m], base frame. Replaces target and stand-off by settled ones.
    // Changes plane, normal and roll only where they differ from those of most frames. Starts anew after 0.25
    // s without a set.
    void apply(std::span<GuidancePose> poses, const Scene& scene, const dvec3& camera, double captureTime);
    void forget() noexcept { classes_.clear(); }

private:
    struct Settled {
        explicit Settled(const GuidancePose& first);
        void turn(const GuidancePose& pose);

        SteadyVector position, rotation; // [m]; [rad] from `reference`
        dquat reference, turned;         // base_q_tool: the first, and the settled one
        bool planar, rollFree;
        uint32_t others = 0; // frames in a row with another plane or roll
    };
    static void settle(Settled& settled, GuidancePose& pose, double standoff, const dvec3& camera);

    std::map<uint32_t, Settled> classes_; // by index into Scene::fixtures
    double last_ = 0.0;                   // [s] capture time of the last set
};

} // namespace fathom::cloud
