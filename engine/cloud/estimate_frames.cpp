// SPDX-License-Identifier: Apache-2.0
#include "engine/cloud/estimate_frames.h"

#include "engine/cloud/frame_params.h"

namespace fathom::cloud {

namespace {

constexpr double kLongestGap = 0.25; // [s]
constexpr double kStill = 2e-5;      // [m] motion of a point at 1 m that counts as none

bool isStill(const Pose& a, const Pose& b) {
    const Pose moved = inverse(a) * b;
    const dvec3 turn(moved.rotation.x, moved.rotation.y, moved.rotation.z); // half the angle
    return glm::length(moved.position) + 2.0 * glm::length(turn) < kStill;
}

} // namespace

void EstimateFrames::next(shared::FrameParams& params, const Scene& scene, const std::optional<Pose>& pose,
                          const dvec3& origin, double captureTime) {
    const Pose now = pose.value_or(scene.baseTcamera);
    const double since = last_ ? captureTime - last_->time : 0.0;
    const bool wraps = number_ + 1 == shared::kMemoryFrames; // the halves of the memory would not alternate
    const bool known = pose || scene.cameraStatic;
    const bool follows = last_ && known && !wraps && since > 0.0 && since <= kLongestGap;
    params.memory = {wraps ? 1 : number_ + 1, follows ? number_ : 0, scene.filter.memory,
                     scene.filter.memory};
    number_ = params.memory.x;
    const Pose before = follows ? last_->pose : now;
    setRows(params.previousTbase, inverse(Pose{before.position - origin, before.rotation}));
    params.memoryLimits.w = isStill(before, now) ? 0.0f : 1.0f;
    last_.reset();
    if (known) {
        last_ = Last{now, captureTime};
    }
}

} // namespace fathom::cloud
