// SPDX-License-Identifier: Apache-2.0
// Mimic joints of a URDF: which joint each one follows in the end, and the limits that this adds.
#pragma once

#include "engine/model/arm_model.h"

#include <filesystem>
#include <map>
#include <string>
#include <urdf_model/model.h>

namespace fathom {

// A joint at offset + multiplier * (value of the joint `root`, which follows none).
struct JointTie {
    std::string root;
    double multiplier = 1.0, offset = 0.0;
};

// One tie per joint; a joint that follows none is tied to itself. Throws BadInput for mimic joints in a
// cycle, a mimic joint of a missing joint, and numbers that are not finite.
std::map<std::string, JointTie> tieJoints(const urdf::ModelInterface& model,
                                          const std::filesystem::path& file);

// Narrows range and speed of every joint of the chain so that the joints that follow it keep theirs, as far
// as they have any: one note per mimic joint whose range and that of its joint share no value.
std::vector<std::string> narrowByMimics(ArmModel& model);

} // namespace fathom
