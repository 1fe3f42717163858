// SPDX-License-Identifier: Apache-2.0
// Every nth column and row of another camera: fewer pixels to upload and to process.
#pragma once

#include "devices/camera_decorator.h"
#include "devices/frame_slots.h"

namespace fathom {

// Copies the pixels that it keeps. Colour with a lens of its own stays the source's.
class DecimatedCamera final : public CameraDecorator {
public:
    // n: 2 to kMaxDecimation.
    DecimatedCamera(std::unique_ptr<Camera> source, uint32_t n);

    const CameraInfo& info() const override { return info_; }
    std::optional<Frame> next() override;

private:
    uint32_t n_;
    CameraInfo info_;
    FrameSlots slots_;
};

} // namespace fathom
