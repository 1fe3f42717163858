// SPDX-License-Identifier: Apache-2.0
// The proxy of a tool that hangs on an arm: joint angles that follow the hand as well as the joints can, with
// no leaf of any link inside a region. Unknowns are joint increments dq; minimised is
// |J dq - x_u|_M^2 + lambda^2 |dq|^2 (damped least squares, Nakamura and Hanafusa 1986) subject to
// n^T J_leaf dq >= -gap, joint limits and joint speeds, all as rows of the same solver.
#pragma once

#include "engine/contact/contact_set.h"
#include "engine/contact/narrow_phase.h"
#include "engine/haptics/constraint_solver.h"
#include "engine/haptics/tool_motion.h"
#include "engine/model/arm_model.h"

namespace fathom {

// The leaves of the whole arm where the frames put them, as a tool whose frame is the base frame: what the
// contact query asks about, with an identity pose. Allocates: contact cadence. Throws Error beyond 4096
// leaves.
Tool armTool(const ArmModel& arm, const ArmFrames& frames);

namespace armrow {
inline constexpr uint32_t kJoint = ~0u; // in place of a pair: the row of a joint
}

struct ArmProxyOptions {
    double stepCap = 0.002;        // [m] farthest that any leaf of any link travels in one solve
    uint32_t solves = 4;           // linearisations a turn, at most
    double period = 0.001;         // [s] of a turn, for the joint speeds
    double escapePerTurn = 0.001;  // [m] depth given back in one turn where new data lies over a link
    double damping = 1e-3;         // [m/rad] lambda away from singular postures
    double singularBelow = 0.02;   // [m/rad] smallest singular value of M^1/2 J below which lambda grows
    double singularDamping = 0.05; // [m/rad] lambda in the singular posture itself
};

struct ArmTurn {
    JointVector q{};           // after the turn
    Pose tip;                  // base_T_tip after the turn
    double residual = 0.0;     // [m] |what is left to the target|_M: what the pilot feels as the arm's limit
    double minGap = 0.0;       // [m] over the set, as ProxyTurn::minGap
    double manipulability = 0; // [m/rad] smallest singular value of M^1/2 J at the start
    uint32_t contacts = 0;     // rows of leaves that pushed in the last solve
    uint32_t atLimits = 0;     // rows of joint limits or speeds that did
    bool singular = false;     // manipulability below the threshold: damped
    bool escape = false;       // some leaf overlaps a sphere
    bool trapped = false;      // no motion obeys every row: held
    bool stalled = false;      // cut by the trust region
    uint32_t solves = 0;
};

// One thread. Allocates in the constructor only; turn() is noexcept, never locks, throws or waits. Kept by an
// exact check before any posture is taken: no listed pair's gap ends below min(0, its gap before); joints
// never leave [lower, upper] and never go faster than their speed over a turn.
class ArmProxy {
public:
    // The start is clamped to the joint limits. `arm` must outlive this.
    ArmProxy(const ArmModel& arm, const Pose& baseTarm, const ArmProxyOptions& options,
             const JointVector& start);

    // contacts: of armTool() at a recent posture; null = nothing to touch. metricRadius: k = sqrt(K_r / K_t)
    // [m]; 0 = the tip's direction is free.
    ArmTurn turn(const Pose& target, double metricRadius, const ContactSet* contacts) noexcept;

    bool covers(const ContactSet& contacts) noexcept;
    const JointVector& joints() const { return q_; }
    const ArmFrames& frames() const { return frames_; }
    Pose tip() const { return arm_.tip(frames_); }

private:
    static constexpr size_t kMostLeafRows = 512, kMostRows = 1024, kMostViolations = 64;

    struct Goal { // of one linearisation, in joint space
        JointVector wanted{};
        double lambda = 0.0;
    };
    bool step(const Pose& target, double k, const ContactSet* contacts, ArmTurn& out) noexcept;
    Goal aim(const Pose& target, double k, ArmTurn& out) noexcept;
    void addLeafRow(const ContactRow& row, double offset) noexcept;
    void addJointRows() noexcept;
    void collectRows(const ContactSet* contacts, ArmTurn& out) noexcept;
    void tryStep(const JointVector& dq, double share, const dvec3& origin) noexcept;
    double shareToCap(const JointVector& dq, const dvec3& origin) noexcept;
    bool allowed(const ContactSet* contacts, size_t& violating) noexcept;
    bool solveRows(const Goal& goal, JointVector& dq) noexcept;
    bool strengthen(size_t violating, double share) noexcept;
    double fit(JointVector& dq, const Goal& goal, const ContactSet* contacts, ArmTurn& out) noexcept;
    double clampedJoint(size_t k, double q) const noexcept;
    void placeLeaves(const ArmFrames& frames, const dvec3& origin, LeafCentres& out) const noexcept;
    void countActive(ArmTurn& out) const noexcept;

    const ArmModel& arm_;
    Pose base_;
    ArmProxyOptions options_;
    size_t n_;
    JointVector q_{}, start_{}, next_{}; // now, at the start of the turn, tried
    ArmFrames frames_, nextFrames_;
    NarrowPhase narrow_;
    TrustRegion trust_;
    ConstraintSolver solver_;
    LeafCentres leaves_, nextLeaves_;
    std::vector<dvec3> exempt_; // no leaf of an arm is taken for one behind a surface
    std::vector<NarrowPhase::Violation> violations_;
    std::vector<uint32_t> rowPair_; // of solver rows that are leaves'; ~0 for joints
    double escapeLeft_ = 0.0;       // [m] of this turn
};

} // namespace fathom
