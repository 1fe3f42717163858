// SPDX-License-Identifier: Apache-2.0
// One JPEG picture of a motion-JPEG stream, decoded by libjpeg-turbo.
#pragma once

#include "devices/v4l2/video_node.h"

#include <cstddef>
#include <span>
#include <string>

namespace fathom {

// R8 G8 B8 A8 (0xAABBGGRR), alpha 255. Returns what is wrong with it, empty when it was decoded whole;
// another size than `size` is wrong. Any thread.
std::string readJpeg(std::span<const std::byte> bytes, VideoSize size, std::span<uint32_t> out);

} // namespace fathom
