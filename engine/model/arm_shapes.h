// SPDX-License-Identifier: Apache-2.0
// The collision shapes of an arm's links on their way to leaves.
#pragma once

#include "engine/model/arm_model.h"

#include <filesystem>
#include <string>
#include <urdf_model/link.h>
#include <vector>

namespace fathom {

// What moves a link.
struct LinkCarrier {
    uint32_t joint = 0;  // number of chain joints
    uint32_t finger = 0; // 0 = none, else one more than its index
};

class ArmShapes {
public:
    // frameTlink: of the link in the frame of its carrier.
    void add(const urdf::Link& link, const Pose& frameTlink, const LinkCarrier& carrier);

    // Covers all shapes, in the order of add(), and adds leaves, links and notes to the model. Throws
    // BadInput.
    void cover(const std::filesystem::path& urdf, const ArmOptions& options, ArmModel& model) const;

private:
    struct Shape {
        std::string link;
        std::shared_ptr<const urdf::Geometry> geometry;
        Pose frameTshape;
        LinkCarrier carrier;
    };
    std::vector<Shape> shapes_;
};

} // namespace fathom
