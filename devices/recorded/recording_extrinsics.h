// SPDX-License-Identifier: Apache-2.0
// How colour lies to depth, by a JSON file.
#pragma once

#include "devices/recorded/json_field.h"
#include "engine/types/pose.h"

#include <filesystem>
#include <optional>
#include <string>

namespace fathom {

// colourTdepth of a JSON file with t [m] and q_xyzw, or with extrinsics_topic_tf. Throws BadInput naming the
// file and field, also for lenses over 1 m apart or over 90 degrees away from each other.
Pose readExtrinsics(const std::filesystem::path& file);

// Why a pose is not that of lenses of one rig, which are not metres apart, as values of millimetres are, and
// see in one direction; nothing where it may be.
struct RigFault {
    std::string value, allowed;
    bool turned; // else apart
};
std::optional<RigFault> rigFault(const Pose& colourTdepth);

// That of extrinsics_topic_tf in this document. Throws as above.
Pose readColourTdepth(const JsonField& root, const std::string& file);

} // namespace fathom
