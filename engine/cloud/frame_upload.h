// SPDX-License-Identifier: Apache-2.0
// Writes one frame into an upload slot.
#pragma once

#include "engine/cloud/cloud_buffers.h"
#include "engine/types/frame.h"
#include "shaders/shared/frame_params.h"

namespace fathom::cloud {

// The bytes of a frame's colour that a camera of this format and size [pixels] sends; empty when the frame's
// colour has another format or size.
std::span<const std::byte> colourOf(const Frame& frame, ColourFormat format, uint32_t width, uint32_t height);

// Copies parameters, depth and, if the plan uses it, colour; skips images that the slot reads in place. The
// slot's last submission must have completed. Throws Error when an image is smaller than the camera's size.
void uploadFrame(const UploadBuffers& slot, const Frame& frame, const shared::FrameParams& params);

} // namespace fathom::cloud
