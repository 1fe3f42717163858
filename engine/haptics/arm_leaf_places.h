// SPDX-License-Identifier: Apache-2.0
// Where an arm's leaves are, frame by frame.
#pragma once

#include "engine/contact/leaf_centres.h"
#include "engine/model/arm_model.h"

#include <vector>

namespace fathom {

// noexcept and without allocation after the constructor; one thread.
class ArmLeafPlaces {
public:
    explicit ArmLeafPlaces(const ArmModel& arm);

    // Leaf centres about `origin` [m]: ArmModel::centre() but for rounding.
    void place(const ArmFrames& frames, const dvec3& origin, LeafCentres& out) const noexcept;

private:
    struct Run { // leaves one after the other that one frame carries
        size_t frame, first, count;
    };
    std::vector<Run> runs_;
    LeafCentres centres_; // each in its own frame [m]
};

} // namespace fathom
