// SPDX-License-Identifier: Apache-2.0
// Kinematics of a free tool for ConstrainedProxy. Unknowns: translation and rotation about the tool's centre.
#pragma once

#include "engine/haptics/proxy_kinematics.h"
#include "engine/haptics/tool_motion.h"

#include <algorithm>
#include <span>

namespace fathom {

// proxy_kinematics.h documents the public functions. One thread. Allocates in the constructor only;
// everything else is noexcept.
class ToolKinematics {
public:
    static constexpr bool kHoldsOnlyInside = false;
    using Step = ProxyStep;
    static constexpr bool kSolvesLastRound = false; // bisect the last checked motion
    // The motions that the solver found, and how much of them is taken.
    struct Answer {
        Motion escape; // smallest motion that satisfies every row (zero unless some row requests motion)
        Motion full;   // nearest to the target
        double escapeFraction = 0.0; // of `escape`, within the caps
        double targetFraction = 0.0; // from there to `full`
        double trustFraction = 0.0;  // of the result, within the trust region
        bool whole = false;          // the target itself, uncut
        bool stalled = false;        // cut by the trust region
    };

    ToolKinematics(const Tool& tool, const ProxyOptions& options, const Pose& start);

    size_t unknowns() const noexcept { return 6; }
    const Pose& pose() const noexcept { return pose_; }
    const dvec3& origin() const noexcept { return pose_.position; }
    const Pose& nextPose() const noexcept { return nextPose_; }
    void setPose(const Pose& pose) noexcept;
    void setTarget(const Pose& target) noexcept { target_ = target; }
    void place(LeafState& leaves) const noexcept { places_.place(pose_, leaves.origin, leaves.now); }

    void begin(const ProxyInput& input, ProxyRows& rows) noexcept;
    void report(ProxyStep& out) const noexcept;

    // Rows.
    void addLimits(ProxyRows&) const noexcept {}
    bool addRow(const ContactRow& row, const LeafState& leaves, ProxyRows& rows) const noexcept;
    double escapeOffset(double depth) const noexcept {
        return std::max(proxy::kSkin, std::min(proxy::kSkin + depth, depthLeft()));
    }
    // A rotation is limited by its arc at the tool's bounding radius.
    double equalityLimit(const Equality& e) const noexcept {
        return depthLeft() / (e.linear == dvec3(0.0) ? boundingRadius_ : 1.0);
    }
    Sphere bound() const noexcept { return {pose_.position, boundingRadius_}; }
    dvec3 leafNow(size_t leaf, const LeafState&) const noexcept {
        return pose_.position + pose_.rotation * places_.centre(leaf);
    }
    dvec3 leafNext(size_t leaf, const LeafState&) const noexcept {
        return nextPose_.position + nextPose_.rotation * places_.centre(leaf);
    }
    dvec3 lever(size_t leaf, const dvec3&) const noexcept { return pose_.rotation * places_.centre(leaf); }

    // One linearisation.
    bool beginLinearisation(const ProxyRows& rows, const ProxyStep& out) noexcept;
    bool solve(Answer& answer, bool again, ProxyRows& rows, ProxyStep& out) const noexcept;
    bool cutAndTry(Answer& answer, LeafContacts& contacts, const ProxyRows& rows) noexcept;
    double fullFraction(const Answer&) const noexcept { return 1.0; }
    void tryFraction(const Answer& answer, double fraction, LeafState& leaves) noexcept;
    StepOutcome outcomeOf(const Answer& answer, double fraction, const LeafState& leaves, ProxyRows& rows,
                          ProxyStep& out) noexcept;
    void commit() noexcept { pose_ = nextPose_; }
    void recordAllowed(const Answer& answer, bool blocked, const LeafContacts& contacts,
                       const ProxyRows& rows, ProxyStep& out) noexcept;

    // Tightening.
    double triedFraction(const Answer& answer) const noexcept {
        return answer.trustFraction * answered(answer);
    }
    double shortfall(const NarrowPhase::Violation& violation, double needed,
                     const LeafState& leaves) const noexcept;
    double raised(double offset, double amount, double tried) const noexcept {
        return offset + (amount * scaleOf(tried) + proxy::kSkin);
    }
    double arcOf(const Answer& answer, const ContactRow& row, const LeafState& leaves) const noexcept;
    bool tightenEqualities(std::span<const Shape>, double, ProxyRows&) const noexcept { return false; }

private:
    struct Budget {          // per tick, over all solves
        double depth = 0.0;  // [m] separation that rows may request of touching pairs
        double travel = 0.0; // [m] leaf travel allowed for it
        double follow = 0.0; // [m] leaf travel allowed towards the target
    };
    // Rows describe the whole solution, but only `tried` of it was tried.
    static double scaleOf(double tried) noexcept { return 1.0 / std::max(tried, 1e-9); }
    static double answered(const Answer& answer) noexcept {
        return answer.escapeFraction * (1.0 - answer.targetFraction) + answer.targetFraction;
    }
    static Motion motionOf(const Answer& answer, double fraction) noexcept;
    double depthLeft() const noexcept { return budget_.travel > proxy::kSkin ? budget_.depth : 0.0; }
    void setMetric(double radius, ProxyRows& rows) noexcept;
    bool solveFor(const Motion& wanted, Motion& motion, ProxyRows& rows, ProxyStep& out) const noexcept;
    double fractionToCap(const Motion& first, const Motion& rest, double firstBound, double cap,
                         LeafState& leaves) const noexcept;
    Motion applyFriction(Motion& full, ProxyRows& rows, ProxyStep& out) const noexcept;
    bool comesNearer(const Motion& taken) const noexcept;

    LeafPlaces places_;
    double boundingRadius_;             // [m]
    double stepCap_, escape_, catchUp_; // [m] per solve, per tick, per tick
    double mostTravel_;                 // [m] per tick, of any leaf
    double friction_;                   // mu
    Pose pose_, nextPose_, target_;
    double metricRadius_ = 0.0;
    Budget budget_;
    bool hasTarget_ = false; // some tick had a target
    double cutTravel_ = 0.0; // [m] leaf travel that the last solve's caps cut
    Motion wanted_;          // remaining motion to the target, per linearisation
    bool newData_ = false;   // rows requested motion before any was tightened
};

} // namespace fathom
