// SPDX-License-Identifier: Apache-2.0
// Camera that shows one organised PCD: the depth picture and the lens that its points came from.
#pragma once

#include "devices/camera.h"
#include "devices/frame_slots.h"
#include "devices/pcd/pcd_file.h"

#include <optional>

namespace fathom {

struct FittedLens {
    Intrinsics lens;
    double residual = 0.0;  // [pixels] root of the mean square
    bool upAndBack = false; // the cloud has y up and z backward; else y down and z forward
};

// Fits u = fx x/z + cx and v = fy y/z + cy to all measured points by least squares. Throws Error when there
// are too few or they lie in one line of sight.
FittedLens fitLens(const PcdCloud& cloud);

// One frame. Depth is z in units of 0.1 mm, coarser where the farthest point needs it. The camera's frame is
// the optical one (y down, z forward), whatever the cloud's.
class PcdCamera final : public Camera {
public:
    // Throws BadInput, also for a cloud that no pinhole camera saw (a scan of equal angles): residual over
    // one pixel.
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
    bool upAndBack_ = false, done_ = false;
};

} // namespace fathom
