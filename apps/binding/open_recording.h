// SPDX-License-Identifier: Apache-2.0
// Opens a recording of any supported format.
#pragma once

#include "devices/camera.h"
#include "devices/recorded/source_options.h"

#include <memory>

namespace fathom {

// A folder, or a file: by the ending of its name, in upper or lower case, else by its first bytes. Throws
// BadInput, for a file of another kind with the kinds that are read.
std::unique_ptr<Camera> openRecording(const SourceRequest& request);

} // namespace fathom
