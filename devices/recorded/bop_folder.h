// SPDX-License-Identifier: Apache-2.0
// Folders of the BOP benchmark.
#pragma once

#include "devices/recorded/recording_layout.h"

namespace fathom {

// Reads scene_camera.json, and rgb/ and depth/ paired by number. All images must have one lens and depth
// scale, unless the request gives a lens. Throws BadInput.
RecordingLayout readBop(const LayoutRequest& request);

} // namespace fathom
