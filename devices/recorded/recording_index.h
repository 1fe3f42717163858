// SPDX-License-Identifier: Apache-2.0
// Which depth picture of a recording goes with which colour picture, and when they were taken.
#pragma once

#include "devices/recorded/recording_intrinsics.h"

#include <filesystem>
#include <string>
#include <vector>

namespace fathom {

// One line of the index: a depth picture and its colour picture.
struct IndexLine {
    double depthStamp = 0.0, colourStamp = 0.0; // [s]
    std::filesystem::path depth, colour;        // files, the folder included
    std::string fault;                          // why the line itself is unusable; empty = usable
};

// One entry a data line of associations.txt ("t_rgb rgb/x.png t_depth depth/x.png"). Without that file:
// rgb.txt and depth.txt ("t path") joined to pairs, closest stamps first, each picture once, at most 0.02 s
// apart, in order of depth.txt (as the TUM tool associate.py does). Without those: the stamps of
// intrinsics.json for the files of depth/ and rgb/ in order of their names, joined alike within pairWithin.
// A recording without colour: one entry a line of depth.txt. Throws BadInput when there is no index, nothing
// in it, or stamps and files differ in number. No path leads out of the folder by its words: such a line has
// a fault, or is left out with a warning. Links are told of by whoever opens the pictures.
std::vector<IndexLine> readIndex(const std::filesystem::path& folder, const RecordingIntrinsics& intrinsics);

} // namespace fathom
