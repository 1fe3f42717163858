// SPDX-License-Identifier: Apache-2.0
// Opens a file or folder of messages as a camera.
#pragma once

#include "devices/camera.h"
#include "devices/recorded/source_options.h"

#include <memory>

namespace fathom {

// Plays its depth images (BagCamera), or its organised clouds where depth=TOPIC names them or no image is
// depth (CloudCamera). Throws BadInput naming file and topic.
std::unique_ptr<Camera> openBag(const std::filesystem::path& file, const SourceOptions& options = {});

} // namespace fathom
