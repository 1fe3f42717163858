// SPDX-License-Identifier: Apache-2.0
// poses.txt of a recording: the camera's poses.
#pragma once

#include "engine/types/pose.h"

#include <filesystem>
#include <vector>

namespace fathom {

class PoseTrack {
public:
    // Lines "t tx ty tz qx qy qz qw" [s, m], base_T_camera, t strictly increasing, quaternions normalised
    // here. Throws BadInput with file and line; at least one line.
    explicit PoseTrack(const std::filesystem::path& file);

    // Interpolates linearly and by the shortest arc; clamps to the first and last pose.
    Pose at(double t) const noexcept;

private:
    struct Stamped {
        double t;
        Pose baseTcamera;
    };
    std::vector<Stamped> poses_;
};

} // namespace fathom
