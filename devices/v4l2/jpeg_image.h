// SPDX-License-Identifier: Apache-2.0
// Decodes one JPEG with libjpeg-turbo.
#pragma once

#include "devices/v4l2/video_node.h"

#include <cstddef>
#include <optional>
#include <span>
#include <string>

namespace fathom {

// R8 G8 B8 A8 (0xAABBGGRR), alpha 255. Returns the fault, or empty when it was decoded completely; a size
// other than `size` is a fault. Any thread.
std::string readJpeg(std::span<const std::byte> bytes, VideoSize size, std::span<uint32_t> out);

// By the first bytes. The size is empty when the head cannot be read.
bool isJpeg(std::span<const std::byte> bytes);
std::optional<VideoSize> jpegSize(std::span<const std::byte> bytes);

} // namespace fathom
