// SPDX-License-Identifier: Apache-2.0
#include "engine/haptics/arm_leaf_places.h"

#include "engine/haptics/tool_motion.h"

namespace fathom {

ArmLeafPlaces::ArmLeafPlaces(const ArmModel& arm)
    : centres_(arm.leaves.size()) {
    for (size_t i = 0; i < arm.leaves.size(); ++i) {
        centres_.set(i, arm.leaves[i].sphere.centre);
        const size_t frame = arm.frameOf(i);
        if (runs_.empty() || runs_.back().frame != frame) {
            runs_.push_back({frame, i, 0});
        }
        ++runs_.back().count;
    }
}

void ArmLeafPlaces::place(const ArmFrames& frames, const dvec3& origin, LeafCentres& out) const noexcept {
    for (const Run& run : runs_) {
        placePoints(centres_, run.first, run.count, frames[run.frame], origin, out);
    }
}

} // namespace fathom
