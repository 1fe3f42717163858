// SPDX-License-Identifier: Apache-2.0
// custom_msg/OBStreamProfileInfo of the Orbbec SDK: lens of a stream, and the pose of depth to colour.
#pragma once

#include "devices/bag/message_cursor.h"
#include "engine/types/camera_info.h"

#include <optional>

namespace fathom {

// One stream as it was recorded.
struct OrbbecProfile {
    Intrinsics lens;                  // pixels of the recorded images
    std::optional<Pose> colourTdepth; // of the depth stream, where colour was recorded, too
};

// Throws Error when the message is truncated, or names a lens model that is not read.
OrbbecProfile orbbecProfile(MessageCursor message);

} // namespace fathom
