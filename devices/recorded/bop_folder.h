// SPDX-License-Identifier: Apache-2.0
// Folders of the BOP benchmark.
#pragma once

#include "devices/recorded/recording_layout.h"

namespace fathom {

// scene_camera.json, rgb/ and depth/ by number, lens and depth_scale of each image, one lens for all
// unless the request has one. Throws
// BadInput.
RecordingLayout readBop(const LayoutRequest& request);

} // namespace fathom
