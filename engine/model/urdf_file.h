// SPDX-License-Identifier: Apache-2.0
// Reads URDF files in a separate process (reader_process.h).
#pragma once

#include "engine/model/reader_process.h"
#include "engine/model/urdf_packet.h"
#include "engine/types/pose.h"

#include <filesystem>
#include <memory>
#include <optional>

namespace fathom {

// Never null; a tree below one root. Of materials, visuals, inertia and sensors it has nothing. Capsules,
// which the parser does not know, are readable with capsuleOf(). Throws BadInput with the parser's message,
// and for xacro files, which must be expanded first.
std::shared_ptr<const UrdfModel> readUrdf(const std::filesystem::path& file,
                                          const ReaderOptions& options = {});

// A cylinder of `length` along z with a half sphere at each end [m].
struct CapsuleSize {
    double radius, length;
};
// Empty when the shape is no capsule.
std::optional<CapsuleSize> capsuleOf(const urdf::Geometry& shape);

// Converts a pose [m]; the quaternion is normalised.
Pose poseOf(const urdf::Pose& pose);

} // namespace fathom
