// SPDX-License-Identifier: Apache-2.0
// Leaf centres of an arm, computed per link frame.
#pragma once

#include "engine/contact/leaf_centres.h"
#include "engine/model/arm_model.h"

#include <vector>

namespace fathom {

// noexcept and without allocation after the constructor; one thread.
class ArmLeafPlaces {
public:
    explicit ArmLeafPlaces(const ArmModel& arm);

    // Leaf centres about `origin` [m]: equal to ArmModel::centre() up to rounding.
    void place(const ArmFrames& frames, const dvec3& origin, LeafCentres& out) const noexcept;

private:
    struct Run { // consecutive leaves that move with one frame
        size_t frame, first, count;
    };
    std::vector<Run> runs_;
    LeafCentres centres_; // each in its own frame [m]
};

} // namespace fathom
