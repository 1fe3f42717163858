// SPDX-License-Identifier: Apache-2.0
// Camera that plays one organised PCD or PLY file: reconstructs the depth image and the lens.
#pragma once

#include "devices/camera.h"
#include "devices/frame_slots.h"
#include "devices/pcd/pcd_file.h"
#include "devices/recorded/source_options.h"

#include <glm/mat3x3.hpp>
#include <optional>
#include <string>

namespace fathom {

// The lens of a cloud's points, fitted by least squares.
struct FittedLens {
    Intrinsics lens;
    double residual = 0.0;         // [pixels] root of the mean square
    glm::dmat3 opticalTcloud{1.0}; // the cloud's axes to x right, y down, z forward
    std::string fault;             // of the points, if they fit in no axes; the residual is infinite then
};

// The cloud's axes may be optical, y up and z backward (graphics), or x forward, y left, z up (robots). Tries
// all three, each as a pinhole (u = fx x/z + cx, v = fy y/z + cy) and as a fan of beams at equal angles, and
// takes the smallest least-squares residual over the points in front of the sensor. Throws Error when the
// points are too few or all on one ray.
FittedLens fitLens(const PcdCloud& cloud);
// Warning that the points may not be in the frame of their camera: those of a plane fit some lens from
// everywhere. Empty for a lens as cameras have it.
std::string lensWarning(const Intrinsics& lens);

// One frame. Depth is z in units of 0.1 mm, coarser when the farthest point within options.farthest needs it;
// points that do not fit then are not measured. The camera frame is the
// optical one, independent of the cloud's axes. Without colour, the field `intensity` becomes grey; full
// scale is the smallest of 1, 255 and 65535 that contains the maximum.
class PcdCamera final : public Camera {
public:
    // options.scale: metres per unit of the points, else 1. options.colour: "none" or empty. Throws BadInput,
    // also for other options, and when neither a pinhole nor a fan fits within one pixel.
    explicit PcdCamera(const std::filesystem::path& file, const SourceOptions& options = {});

    const CameraInfo& info() const override { return info_; }
    std::optional<Frame> next() override;
    uint32_t skipped() const override { return 0; }
    std::vector<std::string> warnings() const override;
    std::string whyNoColour() const override;
    std::string description() const override { return "cloud " + file_.string(); }

private:
    void scalePoints(const FittedLens& fit, const SourceOptions& options);

    std::filesystem::path file_;
    CameraInfo info_;
    std::optional<FrameSlots> slots_;
    PcdCloud cloud_;
    std::vector<std::string> warnings_; // of the lens, the pose and the unit
    double farthest_ = 0.0;             // [m] of interest
    bool done_ = false;
};

} // namespace fathom
