// SPDX-License-Identifier: Apache-2.0
// Folders of images frame-N.depth.png: 7-Scenes, BundleFusion, 3RScan, and what ScanNet's SensReader exports.
#pragma once

#include "devices/recorded/recording_layout.h"

namespace fathom {

// Whether the folder has an image frame-N.depth.ENDING of a kind that is read.
bool hasFrameImages(const std::filesystem::path& folder);

// Colour is frame-N.color.ENDING, poses are those of frame-N.pose.txt. Sizes, lenses and unit are those of
// info.txt or _info.txt (m_depthWidth, m_calibrationDepthIntrinsic, m_depthShift in units per metre, ...), or
// of info.txt in the folder above, that of a link or of its target; their extrinsics must be the identity;
// colour with the lens of depth is registered. Without such a file: the nominal lens of 7-Scenes, registered,
// with a warning, and 65535 is no measurement. Throws BadInput.
RecordingLayout readFrameFolder(const LayoutRequest& request);

} // namespace fathom
