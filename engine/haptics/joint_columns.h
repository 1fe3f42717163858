// SPDX-License-Identifier: Apache-2.0
// The columns of an arm's Jacobian: one for each free joint. A mimic joint adds to that of the joint which it
// follows.
#pragma once

#include "engine/model/arm_model.h"

#include <array>
#include <cstddef>

namespace fathom {

struct JointColumns {
    std::array<size_t, kMaxJoints> column{}; // unknown that moves each joint
    JointVector gain{};                      // motion of each joint per motion of its unknown
    size_t unknowns = 0;

    explicit JointColumns(const ArmModel& arm) noexcept {
        for (size_t k = 0; k < arm.count(); ++k) {
            gain[k] = 1.0;
            column[k] = arm.joints[k].mimic ? 0 : unknowns++;
        }
        for (size_t k = 0; k < arm.count(); ++k) {
            if (const auto& mimic = arm.joints[k].mimic) {
                column[k] = column[mimic->joint];
                gain[k] = mimic->multiplier;
            }
        }
    }
};

} // namespace fathom
