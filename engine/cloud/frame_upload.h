// SPDX-License-Identifier: Apache-2.0
// Writes one frame into an upload slot.
#pragma once

#include "engine/cloud/cloud_buffers.h"
#include "engine/types/frame.h"
#include "shaders/shared/frame_params.h"

namespace fathom::cloud {

// Copies the parameters, depth and, when the plan has it, colour, unless the slot has them where the frame
// does. The slot's last submission must have completed. Throws Error when the frame's images are smaller than
// the camera said.
void uploadFrame(const UploadBuffers& slot, const Frame& frame, const shared::FrameParams& params);

} // namespace fathom::cloud
