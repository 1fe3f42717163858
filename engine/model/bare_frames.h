// SPDX-License-Identifier: Apache-2.0
// Frames of a URDF that carry no shapes, below links of an arm.
#pragma once

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

} // namespace fathom
