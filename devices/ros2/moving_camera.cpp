// SPDX-License-Identifier: Apache-2.0
#include "devices/ros2/moving_camera.h"

namespace fathom {

std::string MovingCamera::follow(const std::string& camera) {
    camera_ = camera.starts_with('/') ? camera.substr(1) : camera;
    return transforms_.whyApart(camera_, fixed_);
}

void MovingCamera::add(LivePairs::Pair pair) {
    waiting_.push_back(std::move(pair));
}

std::optional<MovingCamera::Posed> MovingCamera::next(double now) {
    if (waiting_.empty()) {
        return std::nullopt;
    }
    const LiveImage& depth = waiting_.front().depth;
    LiveTransforms::Answer answer = transforms_.pose(camera_, fixed_, depth.stamp);
    const bool patient = now < depth.message->arrival + kPatience && waiting_.size() <= kMaxWaiting;
    if (!answer.pose && answer.early && patient) {
        return std::nullopt;
    }
    Posed posed{std::move(waiting_.front()), answer.pose,
                answer.why.empty() ? "" : "no pose at its stamp: " + answer.why};
    waiting_.pop_front();
    return posed;
}

void MovingCamera::clear() {
    waiting_.clear();
    transforms_.forgetMoving();
}

} // namespace fathom
