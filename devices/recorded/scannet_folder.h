// SPDX-License-Identifier: Apache-2.0
// Folders of ScanNet and of its benchmark.
#pragma once

#include "devices/recorded/recording_layout.h"

namespace fathom {

inline constexpr const char* kScanNetFramesLens = "intrinsics_depth.txt"; // of scannet_frames_25k

// Reads the lenses in the folder of the request's mark, and color/ and depth/ paired by number, in
// millimetres, with a pose per image in pose/. Throws BadInput.
RecordingLayout readScanNet(const LayoutRequest& request);

} // namespace fathom
