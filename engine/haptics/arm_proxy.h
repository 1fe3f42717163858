// SPDX-License-Identifier: Apache-2.0
// The proxy of a tool that hangs on an arm: joint angles that follow the hand as well as the joints can, with
// no leaf of any link inside a region. Unknowns are joint increments dq; minimised is
// |J dq - x_u|_M^2 + lambda^2 |dq|^2 (damped least squares, Nakamura and Hanafusa 1986) subject to
// n^T J_leaf dq >= -gap, joint limits and joint speeds, all as rows of the same solver.
#pragma once

#include "engine/contact/contact_set.h"
#include "engine/contact/narrow_phase.h"
#include "engine/contact/shapes.h"
#include "engine/haptics/arm_leaf_places.h"
#include "engine/haptics/constraint_solver.h"
#include "engine/haptics/proxy.h"
#include "engine/haptics/tool_motion.h"
#include "engine/model/arm_model.h"

namespace fathom {

// The leaves of the whole arm where the frames put them, as a tool whose frame is the base frame: what the
// contact query asks about, with an identity pose. Allocates: contact cadence. Throws Error beyond 4096
// leaves.
Tool armTool(const ArmModel& arm, const ArmFrames& frames);

// How an arm's proxy moves; fixed when it is made.
struct ArmProxyOptions {
    double stepCap = 0.002;        // [m] farthest that any leaf of any link travels in one solve
    uint32_t solves = 4;           // linearisations a turn, at most
    double period = 0.001;         // [s] of a turn, for the joint speeds
    double escapePerTurn = 0.001;  // [m] depth given back in one turn where new data lies over a link
    double damping = 1e-3;         // [m/rad] lambda away from singular postures
    double singularBelow = 0.02;   // [m/rad] smallest singular value of M^1/2 J below which lambda grows
    double singularDamping = 0.05; // [m/rad] lambda in the singular posture itself
    double graspPerTurn = 0.0;     // of the whole way from open to closed, in one turn
};

// What a turn asks of the arm.
struct ArmInput {
    Pose target;                          // base_T_tip that the hand asks for
    double metricRadius = 0.1;            // [m] k = sqrt(K_r / K_t); 0 = the tip's direction is free
    const ContactSet* contacts = nullptr; // of armTool() at a recent posture; null = nothing to touch
    double grasp = 0.0;                   // 0 open .. 1 closed that is asked for; not finite = as it is
    Deadline deadline;
};

// What became of it.
struct ArmStep {
    JointVector q{};           // after the turn
    double grasp = 0.0;        // after the turn
    Pose tip;                  // base_T_tip after the turn
    double residual = 0.0;     // [m] |what is left to the target|_M: what the pilot feels as the arm's limit
    double minGap = 0.0;       // [m] over the set, as ProxyStep::minGap
    double manipulability = 0; // [m/rad] smallest singular value of M^1/2 J at the start
    uint32_t contacts = 0;     // rows of leaves that pushed in the last solve
    uint32_t atLimits = 0;     // rows of joint limits or speeds that did
    bool singular = false;     // manipulability below the threshold: damped
    bool escape = false;       // some leaf overlaps a sphere
    bool trapped = false;      // no motion obeys every row: held
    bool stalled = false;      // cut by the trust region
    bool graspHeld = false;    // a finger would have entered a region: the grasp stays
    uint32_t solves = 0;
    uint32_t infeasible = 0; // solver calls that found no motion
    std::span<const ActiveContact>
        active; // rows of leaves that pushed, arms about the tip; until the next turn
};

// One thread. Allocates in the constructor only; turn() is noexcept, never locks, throws or waits. Kept by an
// exact check before any posture is taken: no listed pair's gap ends below min(0, its gap before), nor any
// leaf's to an authored shape; joints never leave [lower, upper] and never go faster than their speed over a
// turn. Exempt are pairs that would hold a leaf behind a surface, as for a free tool. Lines and axes bind the
// tip, as far as the joints can.
class ArmProxy {
public:
    // The start is clamped to the joint limits. `arm` must outlive this.
    ArmProxy(const ArmModel& arm, const Pose& baseTarm, const ArmProxyOptions& options,
             const JointVector& start, std::span<const Shape> shapes = {});

    ArmStep step(const ArmInput& input) noexcept;
    ArmStep step(const Pose& target, double metricRadius, const ContactSet* contacts) noexcept {
        return step({target, metricRadius, contacts, grasp_, {}});
    }

    bool covers(const ContactSet& contacts) noexcept;
    // Stands there from now on, clamped to the joint limits, whatever lies there; what is not finite stays as
    // it is. A set in force may not cover it any more: ask covers().
    void setPosture(const ArmPosture& posture) noexcept;
    // As Proxy::setShapes().
    void setShapes(std::span<const Shape> shapes) noexcept;
    std::span<const Shape> shapes() const noexcept { return shapes_; }

    const JointVector& joints() const { return q_; }
    ArmPosture posture() const { return {q_, grasp_}; }
    const ArmFrames& frames() const { return frames_; }
    Pose tip() const { return arm_.tip(frames_); }
    size_t leafCount() const { return arm_.leaves.size(); }
    double leafRadius(size_t leaf) const { return arm_.leaves[leaf].sphere.radius; }

private:
    static constexpr size_t kMostLeafRows = 512, kMostRows = 1280, kMostViolations = 64;

    struct Goal { // of one linearisation, in joint space
        JointVector wanted{};
        double lambda = 0.0;
    };
    struct SolverRow { // what a row of the solver is about
        ContactRow row;
        bool joint = false; // a limit of place or speed: `row` means nothing
    };

    // arm_proxy.cpp
    Goal aim(const ArmInput& input, ArmStep& out) noexcept;
    void moveGrasp(const ArmInput& input, ArmStep& out) noexcept;
    void report(const ArmInput& input, bool usable, ArmStep& out) noexcept;

    // arm_proxy_rows.cpp: the conditions on the next joint increments.
    void collectRows(const ContactSet* contacts, bool anew, ArmStep& out) noexcept;
    void gather(const ContactSet& contacts, bool anew) noexcept;
    void addPairRows(const ContactSet& contacts) noexcept;
    void addBehindRows(const ContactSet& contacts) noexcept;
    void addShapeRows(ArmStep& out) noexcept;
    void addEqualityRows(const Shape& shape, uint32_t index) noexcept;
    void addJointRows() noexcept;
    void addLeafRow(const ContactRow& row, double offset) noexcept;
    void addRow(const JointVector& normal, double offset, const SolverRow& what) noexcept;
    bool tighten(size_t violating, double share) noexcept;
    bool tightenShapes(double share) noexcept;
    bool tightenEqualities(double share) noexcept;
    void recordActive(ArmStep& out) noexcept;

    // arm_proxy_step.cpp: solve, cut, check, and only then move.
    bool step(const ArmInput& input, ArmStep& out) noexcept;
    bool solveRows(const Goal& goal, JointVector& dq, ArmStep& out) noexcept;
    double fit(JointVector& dq, const Goal& goal, const ContactSet* contacts, ArmStep& out) noexcept;
    double bisect(const JointVector& dq, double most, const ContactSet* contacts) noexcept;
    double shareToCap(const JointVector& dq) noexcept;
    void tryPosture(const JointVector& q, double grasp) noexcept;
    void tryStep(const JointVector& dq, double share) noexcept;
    bool allowed(const ContactSet* contacts, size_t& violating) noexcept;
    bool shapesAllow() const noexcept;
    void take() noexcept;
    double clampedJoint(size_t k, double q) const noexcept;

    const ArmModel& arm_;
    Pose base_;
    ArmProxyOptions options_;
    size_t n_;
    JointVector q_{}, start_{}, next_{}; // now, at the start of the turn, tried
    double grasp_ = 0.0, nextGrasp_ = 0.0;
    ArmFrames frames_, nextFrames_;
    std::vector<Shape> shapes_;
    NarrowPhase narrow_;
    TrustRegion trust_;
    ConstraintSolver solver_;
    ArmLeafPlaces places_;
    LeafCentres leaves_, nextLeaves_; // centres about origin_
    dvec3 origin_{0.0};               // [m] base frame: of the set in force
    std::vector<dvec3> exempt_;       // a leaf: way to the camera while it is behind, else zero
    std::vector<double> clearance_;   // a leaf: [m] left along it
    std::vector<NarrowPhase::Violation> violations_;
    std::vector<SolverRow> rows_; // of the solver
    double escapeLeft_ = 0.0;     // [m] of this turn
    std::array<ActiveContact, kMaxUnknowns> active_;
    size_t activeCount_ = 0;
};

} // namespace fathom
