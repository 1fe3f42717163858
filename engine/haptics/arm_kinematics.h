// SPDX-License-Identifier: Apache-2.0
// Kinematics of an arm for ConstrainedProxy. The unknowns are increments dq of the free joints; mimic joints
// add to the column of the joint that they follow. The solver minimises |J dq
// - x_u|_M^2 + lambda^2 |dq|^2 (damped least squares, Nakamura and Hanafusa 1986) subject to n^T J_leaf dq >=
// -gap, joint limits and joint speeds, all as rows of the same solver.
#pragma once

#include "engine/haptics/arm_damping.h"
#include "engine/haptics/arm_leaf_places.h"
#include "engine/haptics/joint_columns.h"
#include "engine/haptics/proxy_kinematics.h"
#include "engine/haptics/singular_release.h"
#include "engine/haptics/tool_motion.h"
#include "engine/model/arm_model.h"

#include <algorithm>
#include <limits>
#include <span>
#include <vector>

namespace fathom {

// Motion options of an arm's proxy, fixed at construction. The step cap applies to every leaf of every link.
struct ArmProxyOptions : ProxyOptions {
    double damping = 1e-3;         // [m/rad] lambda away from singular postures
    double singularBelow = 0.02;   // [m/rad] smallest singular value of M^1/2 J below which lambda grows
    double singularDamping = 0.05; // [m/rad] lambda at the singular posture
    ReleaseWeights release;        // how a singular posture is left
    double graspPerTick = 0.0;     // most change of the grasp per tick; 1 = from open to closed
};

// The result of a tick; `pose` is base_T_tip.
struct ArmStep : ProxyStep {
    JointVector q{};                  // after the tick
    double grasp = 0.0;               // after the tick
    double residual = 0.0;            // [m] distance to the target in the metric M
    double smallestSingularValue = 0; // [m/rad] of M^1/2 J at the start; 0 = singular
    uint32_t atLimits = 0;         // joint limit and speed rows with a positive multiplier in the last solve
    uint32_t atPositionLimits = 0; // active position limits of joints; atLimits also counts speed limits
    bool singular = false;         // smallestSingularValue is below the threshold: damped
    bool flipped = false;          // a singular posture was left to another side than the arm came from
    bool graspHeld = false;        // a finger would have entered a region, so the grasp did not change
};

// proxy_kinematics.h documents most public functions. One thread. Allocates in the constructor only;
// everything else is noexcept. `arm` must outlive it.
class ArmKinematics {
public:
    using Step = ArmStep;
    static constexpr bool kHoldsOnlyInside = true; // keep_in shapes do not pull in the other links
    static constexpr bool kSolvesLastRound = true; // bisect the result of the last tightening
    // The motion that the solver found, and how much of it is taken.
    struct Answer {
        JointVector dq{};         // of the free joints
        double capFraction = 1.0; // of the solution, within the step cap
        bool stalled = false;     // cut by the trust region
    };

    ArmKinematics(const ArmModel& arm, const Pose& baseTarm, const ArmProxyOptions& options);

    size_t unknowns() const noexcept { return free_.size(); }
    Pose pose() const noexcept { return arm_.tip(now_.frames); }
    const dvec3& origin() const noexcept { return now_.frames[0].position; }
    Pose nextPose() const noexcept { return arm_.tip(next_.frames); }
    const ArmPosture& posture() const noexcept { return now_.posture; }
    const ArmFrames& frames() const noexcept { return now_.frames; }
    void setPosture(const ArmPosture& posture) noexcept;
    void place(LeafState& leaves) const noexcept { places_.place(now_.frames, leaves.origin, leaves.now); }
    void tryGrasp(double grasp, LeafState& leaves) noexcept { tryPosture(now_.posture.q, grasp, leaves); }

    void begin(const ProxyInput& input, ProxyRows&) noexcept;
    void report(ArmStep& out) const noexcept;

    // Rows.
    void addLimits(ProxyRows& rows) const noexcept;
    bool addRow(ContactRow row, const LeafState& leaves, ProxyRows& rows) const noexcept;
    double escapeOffset(double depth) const noexcept { return std::min(depth, escapeLeft_) + proxy::kSkin; }
    double equalityLimit(const Equality&) const noexcept { return escapeLeft_; }
    Sphere bound() const noexcept { return {pose().position, std::numeric_limits<double>::infinity()}; }
    dvec3 leafNow(size_t leaf, const LeafState& leaves) const noexcept {
        return leaves.now[leaf] + leaves.origin;
    }
    dvec3 leafNext(size_t leaf, const LeafState& leaves) const noexcept {
        return leaves.next[leaf] + leaves.origin;
    }
    dvec3 lever(size_t, const dvec3& centre) const noexcept { return centre - pose().position; }

    // One linearisation.
    bool beginLinearisation(ProxyRows& rows, ArmStep& out) noexcept;
    bool solve(Answer& answer, bool again, ProxyRows& rows, ArmStep& out) const noexcept;
    bool cutAndTry(Answer& answer, LeafContacts& contacts, const ProxyRows&) noexcept;
    double fullFraction(const Answer& answer) const noexcept { return answer.capFraction; }
    void tryFraction(const Answer& answer, double fraction, LeafState& leaves) noexcept;
    StepOutcome outcomeOf(const Answer&, double fraction, const LeafState& leaves, ProxyRows&,
                          const ArmStep& out) noexcept;
    void commit() noexcept { now_ = next_; }
    // An arm reports `allowed` in every tick, because it may not reach a target for reasons without a force:
    // joint speeds, the workspace, a singular posture.
    void recordAllowed(const Answer& answer, bool blocked, const LeafContacts& contacts, ProxyRows& rows,
                       ArmStep& out) const noexcept;

    // Tightening.
    double triedFraction(const Answer& answer) const noexcept { return answer.capFraction; }
    double shortfall(const NarrowPhase::Violation& violation, double, const LeafState&) const noexcept {
        return violation.depth;
    }
    double raised(double offset, double amount, double tried) const noexcept {
        return offset + amount / std::max(tried, 1e-6) + proxy::kSkin;
    }
    double arcOf(const Answer&, const ContactRow&, const LeafState&) const noexcept { return 0.0; }
    bool tightenEqualities(std::span<const Shape> shapes, double tried, ProxyRows& rows) const noexcept;

private:
    struct State {
        ArmPosture posture;
        ArmFrames frames;
    };
    struct Range { // [rad], [m] allowed motion of a joint in this tick
        double low, high;
    };
    Range rangeOf(size_t unknown) const noexcept;
    Motion motionOf(const JointVector& dq) const noexcept; // of the tip
    JointVector uncutAnswer(const Answer& answer, ProxyRows& rows) const noexcept;
    JointVector normalOf(const ContactRow& row, const LeafState& leaves) const noexcept;
    JointVector leafNormal(const ArmLeaf& leaf, const dvec3& centre, const dvec3& direction) const noexcept;
    void tryPosture(const JointVector& q, double grasp, LeafState& leaves) noexcept;

    const ArmModel& arm_;
    Pose base_;
    ArmProxyOptions options_;
    std::vector<size_t> free_; // joints that follow no other: the unknowns
    JointColumns joints_;
    ArmLeafPlaces places_;
    State now_, next_;
    JointVector start_{}; // joints at the start of the tick
    Pose target_;
    double metricRadius_ = 0.0;
    ArmNormal normal_;        // of this linearisation
    JointVector wanted_{};    // target of this linearisation, free joints
    double escapeLeft_ = 0.0; // [m] left in this tick
    SingularRelease release_;
    bool nudged_ = false; // `wanted_` contains a step of release_
};

} // namespace fathom
