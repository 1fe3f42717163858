// SPDX-License-Identifier: Apache-2.0
// Opens a recording of any supported format.
#pragma once

#include "devices/bag/message_file.h"
#include "devices/camera.h"
#include "devices/recorded/source_options.h"

#include <memory>

namespace fathom {

// A folder, or a file: by the ending of its name, in upper or lower case, else by its first bytes. Throws
// BadInput, for a file of another kind with the kinds that are read.
std::unique_ptr<Camera> openRecording(const SourceRequest& request);

// The messages of a source, when it is a file or folder of messages; null for any other. Throws BadInput.
std::unique_ptr<MessageFile> openMessages(const std::string& source);

} // namespace fathom
