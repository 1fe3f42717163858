// SPDX-License-Identifier: Apache-2.0
// Camera that shows one organised PCD: the depth picture and the lens that its points came from.
#pragma once

#include "devices/camera.h"
#include "devices/frame_slots.h"
#include "devices/pcd/pcd_file.h"

#include <glm/mat3x3.hpp>
#include <optional>

namespace fathom {

// The lens whose rays the points of a cloud lie on, found by least squares.
struct FittedLens {
    Intrinsics lens;
    double residual = 0.0;         // [pixels] root of the mean square
    glm::dmat3 opticalTcloud{1.0}; // the cloud's axes to x right, y down, z forward
};

// The cloud's axes may be optical, y up and z backward (graphics), or x forward, y left, z up (robots). Of
// the three, as a pinhole (u = fx x/z + cx, v = fy y/z + cy) and as a fan of beams at equal angles, the one
// with the least residual by least squares over the measured points before the sensor. Throws Error when
// there are too few or they lie in one line of sight.
FittedLens fitLens(const PcdCloud& cloud);

// One frame. Depth is z in units of 0.1 mm, coarser where the farthest point needs it. The camera's frame is
// the optical one, whatever the cloud's. Without colour the strength of a field intensity is the picture's
// grey: of the full scales 1, 255 and 65535 the first that holds the largest.
class PcdCamera final : public Camera {
public:
    // Throws BadInput, also for a cloud that neither a pinhole camera nor a fan saw: residual over one pixel.
    explicit PcdCamera(const std::filesystem::path& file);

    const CameraInfo& info() const override { return info_; }
    std::optional<Frame> next() override;
    uint32_t skipped() const override { return 0; }
    std::string description() const override { return "cloud " + file_.string(); }

private:
    std::filesystem::path file_;
    CameraInfo info_;
    std::optional<FrameSlots> slots_;
    PcdCloud cloud_;
    bool done_ = false;
};

} // namespace fathom
