// SPDX-License-Identifier: Apache-2.0
// Suggests the recording that was probably meant.
#pragma once

#include <filesystem>

namespace fathom {

// Throws BadInput for a folder without any mark of a recording: it names a file of messages in it, or a
// recording one or two levels below, else what is read. isRecording: whether a folder has such a mark.
[[noreturn]] void refuseUnknownFolder(const std::filesystem::path& folder,
                                      bool (*isRecording)(const std::filesystem::path&));

// Throws BadInput where depth images lie in a folder of another name than depth, or in the folder itself.
void refuseMisplacedDepth(const std::filesystem::path& folder);

} // namespace fathom
