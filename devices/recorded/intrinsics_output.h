// SPDX-License-Identifier: Apache-2.0
// intrinsics.json of a recording, as readIntrinsics() takes it.
#pragma once

#include "engine/types/camera_info.h"

#include <filesystem>

namespace fathom {

// Throws Error that names the file when it cannot be written.
void writeIntrinsics(const std::filesystem::path& file, const CameraInfo& camera);

} // namespace fathom
