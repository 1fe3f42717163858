// SPDX-License-Identifier: Apache-2.0
// The poses of a camera's images, from the transforms of a ROS 2 graph.
#pragma once

#include "devices/ros2/live_pairs.h"
#include "devices/ros2/live_transforms.h"

#include <deque>
#include <optional>
#include <string>

namespace fathom {

// Images wait for the transforms at their stamps, in their order, at most kPatience. One thread.
class MovingCamera {
public:
    // fixed: the frame in which poses are given. reader: for log lines.
    MovingCamera(const std::string& reader, std::string fixed)
        : transforms_(reader)
        , fixed_(std::move(fixed)) {}

    LiveTransforms& transforms() { return transforms_; }
    // camera: the frame of the images that follow. Returns why no transforms lead to it; empty if some do.
    std::string follow(const std::string& camera);

    // Images whose pose is known, or known to be missing.
    struct Posed {
        LivePairs::Pair pair;
        std::optional<Pose> fixedTcamera;
        std::string fault; // why there is no pose; empty with one
    };
    void add(LivePairs::Pair pair);
    // The oldest images whose pose is settled; now [s] CLOCK_MONOTONIC.
    std::optional<Posed> next(double now);
    bool waits() const { return !waiting_.empty(); }
    void clear(); // the clock of the images was set back

    static constexpr double kPatience = 0.15; // [s] after the arrival of the image

private:
    static constexpr size_t kMaxWaiting = 16;

    LiveTransforms transforms_;
    std::string fixed_, camera_;
    std::deque<LivePairs::Pair> waiting_;
};

} // namespace fathom
