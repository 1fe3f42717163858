// SPDX-License-Identifier: Apache-2.0
// Rejects samples of a live hand that no hand can make.
#pragma once

#include "engine/cycle/step_record.h"

namespace fathom {

// A hand does not move faster than kFastest. A faster sample is either an outlier or correct after a gap. It
// is doubted for at most kDoubt: hand and tool stay, and the force may only fall. If the samples agree with
// each other for that time, they are accepted and the hand is re-indexed there. So a single wrong sample
// moves nothing, and a lasting offset is accepted. If samples contradict each other for longer, or are beyond
// kFarthest, the device counts as gone. Haptic thread; noexcept.
class HandCheck {
public:
    // Sets StepInput::doubtful and reindex for the pose in `input`. A device that is away, or a pose that is
    // not finite, is no sample.
    void judge(StepInput& input) noexcept {
        if (!input.present || !isFinite(input.deviceThandle)) {
            started_ = doubting_ = false; // what comes back is re-indexed by the cycle
            return;
        }
        const Pose& pose = input.deviceThandle;
        const bool agrees = doubting_ && reaches(last_, pose, input.time - lastAt_);
        since_ = agrees ? since_ : input.time;
        last_ = pose;
        lastAt_ = input.time;
        const bool near = glm::length(pose.position) <= kFarthest; // false for what overflows
        const bool plausible = near && (!started_ || reaches(believed_, pose, input.time - believedAt_));
        input.reindex = !plausible && near && agrees && input.time - since_ >= kDoubt - kSlack;
        input.doubtful = !plausible && !input.reindex;
        doubtSince_ = doubting_ ? doubtSince_ : input.time;
        doubting_ = input.doubtful;
        if (doubting_) {
            input.present = input.time - doubtSince_ < kDoubt + kSlack;
        } else {
            believed_ = pose;
            believedAt_ = input.time;
            started_ = true;
        }
    }

    static constexpr double kFastest = 5.0;      // [m/s]
    static constexpr double kFastestTurn = 50.0; // [rad/s]
    static constexpr double kDoubt = 0.004;      // [s]: five samples at 1 kHz
    static constexpr double kFarthest = 1000.0;  // [m] from the device's origin; re-indexing keeps 1e-13 m

private:
    static constexpr double kSlack = 1e-4;     // [s] of timing
    static constexpr double kShortest = 0.001; // [s] a shorter interval counts as this

    static bool reaches(const Pose& from, const Pose& to, double seconds) noexcept {
        const double time = seconds > kShortest ? seconds : kShortest;
        const double turn = glm::length(rotationBetween(from.rotation, to.rotation));
        return glm::distance(from.position, to.position) <= kFastest * time && turn <= kFastestTurn * time;
    }

    Pose believed_, last_;
    double believedAt_ = 0.0, lastAt_ = 0.0, since_ = 0.0, doubtSince_ = 0.0; // [s]
    bool started_ = false, doubting_ = false;
};

} // namespace fathom
