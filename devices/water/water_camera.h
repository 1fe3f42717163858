// SPDX-License-Identifier: Apache-2.0
// Adapts a camera that was calibrated in air to use behind a flat port under water: corrects lenses and
// depth.
#pragma once

#include "devices/camera.h"
#include "devices/frame_slots.h"
#include "devices/water/flat_port.h"

#include <memory>

namespace fathom {

// For stereo and structured light along the image rows; not for time of flight. Depth is rewritten, in
// the source's unit (65535 units are the farthest); colour is the source's own. A lens's own distortion is
// taken as in air and straightened only in the model of the rays, so the source must deliver images without
// distortion. What the model leaves wrong between nearZ and farZ is info().sigma, a third of its largest.
class WaterCamera final : public Camera {
public:
    // Throws BadInput for lenses with distortion or too wide a view.
    WaterCamera(std::unique_ptr<Camera> source, const FlatPort& port, double nearZ, double farZ);

    const CameraInfo& info() const override { return info_; }
    std::optional<Frame> next() override;
    uint32_t skipped() const override { return source_->skipped(); }
    std::vector<std::string> warnings() const override { return source_->warnings(); }
    std::string description() const override { return source_->description() + " behind a flat port"; }
    uint32_t images() const override { return source_->images(); }
    bool seek(uint32_t index) override { return source_->seek(index); }
    bool live() const override { return source_->live(); }
    uint64_t lost() const override { return source_->lost(); }
    std::optional<double> framePeriod() const override { return source_->framePeriod(); }

private:
    std::unique_ptr<Camera> source_;
    CameraInfo info_;
    std::vector<float> factor_;
    float distance_ = 0.0f; // [units]
    FrameSlots slots_;
};

} // namespace fathom
