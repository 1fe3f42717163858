// SPDX-License-Identifier: Apache-2.0
// Frames at the ends of an arm: those below its tip without shapes, and a base below the root.
#pragma once

#include "engine/model/arm_ends.h"

#include <memory>
#include <string>
#include <urdf_model/model.h>
#include <vector>

namespace fathom {

class GripperJoints;

// The body that a frame without shapes only carries, such as the frame of an MJCF joint beside its body.
std::shared_ptr<const urdf::Link> bodyAt(const urdf::ModelInterface& model,
                                         const std::shared_ptr<const urdf::Link>& link);

// The last frame without shapes that fixed joints carry below the link, as long as there is only one; else
// the link.
std::shared_ptr<const urdf::Link> bareEnd(const urdf::ModelInterface& model, const GripperJoints& grippers,
                                          std::shared_ptr<const urdf::Link> link);

// Names of frames without shapes and mass that fixed joints carry below the tip at another pose than its own,
// the nearest first.
std::vector<std::string> framesBelow(const urdf::ModelInterface& model,
                                     const std::shared_ptr<const urdf::Link>& tip);

// Whether the link has another pose than the root, or may have.
bool standsApart(const urdf::Link& base);

// Whether the link is `below` or above it in the tree.
bool isAbove(const urdf::Link& link, std::shared_ptr<const urdf::Link> below);

// Lowers the base below the last planar or floating joint on the way to the tip, if a joint is left below it.
void lowerBase(const urdf::ModelInterface& model, ArmEnds& ends);

} // namespace fathom
