// SPDX-License-Identifier: Apache-2.0
// Pairs the depth and colour images of a recording, with their capture times.
#pragma once

#include "devices/recorded/recording_intrinsics.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace fathom {

// One line of the index: a depth image and its colour image.
struct IndexLine {
    double depthStamp = 0.0, colourStamp = 0.0; // [s]
    std::filesystem::path depth, colour;        // files, the folder included
    std::string fault;                          // why the line is unusable; empty = usable
    std::optional<Pose> baseTcamera;            // where the layout has a pose per image
    bool orderGuessed = false;                  // the paths do not show which image is depth
};

// One entry per data line of associations.txt ("t_rgb rgb/x.png t_depth depth/x.png", or depth first if the
// word depth is in its path only, after the folders of both). Without that file:
// rgb.txt and depth.txt ("t path") joined to pairs, closest stamps first, each image once, at most 0.02 s
// apart, in order of depth.txt (as the TUM tool associate.py does). Without those: the stamps of
// intrinsics.json for the files of depth/ and rgb/ in order of their names (2.png before 10.png), joined
// alike within pairWithin. A recording without colour: one entry per line of depth.txt. depthOnly, for one
// whose colour is not wanted: associations.txt, else depth.txt, else the stamps of depth. Throws BadInput
// when the index is missing or empty, or when stamps and files differ in number. A path that leaves the
// folder makes its line faulty or skips it with a warning. The reader of the images warns about links.
std::vector<IndexLine> readIndex(const std::filesystem::path& folder, const RecordingIntrinsics& intrinsics,
                                 bool depthOnly = false);

} // namespace fathom
