// SPDX-License-Identifier: Apache-2.0
// Adapts a camera that was calibrated in air to use behind a flat port under water: corrects lenses and
// depth.
#pragma once

#include "devices/camera.h"
#include "devices/frame_slots.h"
#include "engine/types/flat_port.h"

#include <memory>

namespace fathom {

// Depth is rewritten (PortCorrection); colour is the source's own.
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
    uint32_t firstImage() const override { return source_->firstImage(); }
    bool seek(uint32_t index) override { return source_->seek(index); }
    bool live() const override { return source_->live(); }
    uint64_t lost() const override { return source_->lost(); }
    std::optional<double> framePeriod() const override { return source_->framePeriod(); }

private:
    std::unique_ptr<Camera> source_;
    CameraInfo info_;
    PortCorrection correction_; // has changed info_
    FrameSlots slots_;
};

} // namespace fathom
