// SPDX-License-Identifier: Apache-2.0
// poses.txt of a recording: the camera's poses.
#pragma once

#include "engine/types/pose.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace fathom {

class PoseTrack {
public:
    // Lines "t tx ty tz qx qy qz qw" [s, m], base_T_camera, t strictly increasing, quaternions within 5 % of
    // length 1, normalised here. Throws BadInput with file and line; at least one line.
    explicit PoseTrack(const std::filesystem::path& file);

    static constexpr double kNear = 0.05;      // [s] from a pose that still holds
    static constexpr double kLongestGap = 1.0; // [s] between poses that are interpolated

    // Interpolates linearly and by the shortest arc. Empty where the track has no pose: more than kNear
    // before the first, after the last, or from both ends of a gap.
    std::optional<Pose> at(double t) const noexcept;
    // Why at(t) is empty.
    std::string whyNone(double t) const;

private:
    struct Stamped {
        double t;
        Pose baseTcamera;
    };
    void warnIfFast(const std::filesystem::path& file) const;
    std::string unitHint(double t) const;
    // The first pose later than t; the end when there is none.
    std::vector<Stamped>::const_iterator after(double t) const noexcept;
    std::vector<Stamped> poses_;
};

} // namespace fathom
