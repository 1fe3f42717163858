// SPDX-License-Identifier: Apache-2.0
// What the motion of the last joint of a chain says: whether it closes a gripper, whatever its name.
#pragma once

#include "engine/model/link_names.h"

#include <string>
#include <urdf_model/model.h>

namespace fathom {

// Whether the joint slides like a jaw: at most 0.1 m to one side of 0, across the way from `last` to it, and
// not along the axis of `last`, the turning joint before it. False without `last`. A quill or a needle slides
// along these.
bool slidesLikeJaw(const urdf::ModelInterface& model, const urdf::Joint& joint, const urdf::Joint* last);

// Whether the joint moves as those of arms and not as a jaw: it turns without end or over 0.5 rad to both
// sides, slides over 0.2 m, or turns a hand by its words. behind: see closesGripper().
bool movesAsArm(const urdf::Joint& joint, const JointWords& words, int behind);

// A note that the joint may close a gripper, if it moves only a little and to one side of 0; else empty.
// holder: the link that carries the gripper then.
std::string jawWarning(const urdf::Joint& joint, const std::string& holder);

} // namespace fathom
