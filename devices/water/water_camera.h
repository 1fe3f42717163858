// SPDX-License-Identifier: Apache-2.0
// Adapts a camera that was calibrated in air to use behind a flat port under water: corrects lenses and
// depth.
#pragma once

#include "devices/camera_decorator.h"
#include "devices/frame_slots.h"
#include "engine/types/flat_port.h"

namespace fathom {

// Depth is rewritten (PortCorrection); colour is the source's own.
class WaterCamera final : public CameraDecorator {
public:
    // Throws BadInput for lenses with distortion or too wide a view.
    WaterCamera(std::unique_ptr<Camera> source, const FlatPort& port, double nearZ, double farZ);

    const CameraInfo& info() const override { return info_; }
    std::optional<Frame> next() override;
    std::string description() const override {
        return CameraDecorator::description() + " behind a flat port";
    }

private:
    CameraInfo info_;
    PortCorrection correction_; // has changed info_
    FrameSlots slots_;
};

} // namespace fathom
