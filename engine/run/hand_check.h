// SPDX-License-Identifier: Apache-2.0
// Rejects samples of a live hand that no hand can make.
#pragma once

#include "engine/cycle/step_record.h"

namespace fathom {

// A hand does not move faster than kFastest. A faster sample is either an outlier or correct after a gap. It
// is unconfirmed for at most kConfirmTime: hand and tool stay, and the force may only fall. If the samples
// agree with each other for that time, they are accepted and the hand is re-indexed there. So a single wrong
// sample moves nothing, and a lasting offset is accepted. If samples contradict each other for longer, or are
// beyond kFarthest, the device counts as gone. A non-finite sample is ignored: the next one is compared with
// the last accepted one. Haptic thread; noexcept.
class HandCheck {
public:
    // The hand was at `start` at `time` [s]: the first sample is compared with it.
    void begin(const Pose& start, double time) noexcept { accept(start, time); }

    // Sets StepInput::unconfirmed and reindex for the pose in `input`. A device that is away is no sample.
    void judge(StepInput& input) noexcept {
        if (!input.present) {
            started_ = unconfirmed_ = false; // what comes back is re-indexed by the cycle
            return;
        }
        if (!isFinite(input.deviceThandle)) {
            sawInvalid_ = true;
            mark(input, unconfirmed_);
            return;
        }
        const Pose& pose = input.deviceThandle;
        const bool agrees = unconfirmed_ && reaches(last_, pose, input.time - lastAt_);
        since_ = agrees ? since_ : input.time;
        last_ = pose;
        lastAt_ = input.time;
        const bool near = glm::length(pose.position) <= kFarthest; // false for what overflows
        const bool plausible = near && (!started_ || reaches(accepted_, pose, sinceAccepted(input.time)));
        input.reindex = !plausible && near && agrees && input.time - since_ >= kConfirmTime - kSlack;
        unconfirmedSince_ = unconfirmed_ ? unconfirmedSince_ : input.time;
        mark(input, !plausible && !input.reindex);
        if (!unconfirmed_) {
            accept(pose, input.time);
        }
    }

    static constexpr double kFastest = 5.0;       // [m/s]
    static constexpr double kFastestTurn = 50.0;  // [rad/s]
    static constexpr double kConfirmTime = 0.004; // [s]: five samples at 1 kHz
    static constexpr double kFarthest = 1000.0;   // [m] from the device's origin; re-indexing keeps 1e-13 m

private:
    void mark(StepInput& input, bool unconfirmed) noexcept {
        input.unconfirmed = unconfirmed_ = unconfirmed;
        input.present = !unconfirmed || input.time - unconfirmedSince_ < kConfirmTime + kSlack;
    }
    void accept(const Pose& pose, double time) noexcept {
        accepted_ = pose;
        acceptedAt_ = time;
        started_ = true;
        sawInvalid_ = false;
    }
    // [s] in which the hand may have moved from where it was accepted. Without sight of it no more than a
    // jump would take to be confirmed.
    double sinceAccepted(double time) const noexcept {
        const double since = time - acceptedAt_;
        return sawInvalid_ && since > kConfirmTime ? kConfirmTime : since;
    }

    static constexpr double kSlack = 1e-4;     // [s] of timing
    static constexpr double kShortest = 0.001; // [s] a shorter interval counts as this

    static bool reaches(const Pose& from, const Pose& to, double seconds) noexcept {
        const double time = seconds > kShortest ? seconds : kShortest;
        const double turn = glm::length(rotationBetween(from.rotation, to.rotation));
        return glm::distance(from.position, to.position) <= kFastest * time && turn <= kFastestTurn * time;
    }

    Pose accepted_, last_;
    double acceptedAt_ = 0.0, lastAt_ = 0.0, since_ = 0.0, unconfirmedSince_ = 0.0; // [s]
    bool started_ = false, unconfirmed_ = false;
    bool sawInvalid_ = false; // a sample since the accepted one was not finite
};

} // namespace fathom
