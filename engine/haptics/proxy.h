// SPDX-License-Identifier: Apache-2.0
// The proxy (virtual tool): the pose that follows the hand and never enters a region. Paper V.B, design 5
// and 6.
#pragma once

#include "engine/contact/contact_set.h"
#include "engine/contact/narrow_phase.h"
#include "engine/contact/shapes.h"
#include "engine/haptics/constraint_solver.h"
#include "engine/haptics/tool_motion.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace fathom {

// Which conditions a solve gets. No choice lets a leaf enter a sphere: the exact check looks at every listed
// pair before a pose is taken, and a pair that it finds violated gets a row. What a choice can cost is lag.
struct RowReduction {
    double reach = 2.0; // pairs farther than this many step caps get no row; below 1 counts as 1
    // [rad] 0..pi/2: a leaf's row stands for its farther pairs within this angle.
    double cone = NarrowPhase::kCone;
    // Rows that lack most at the target, on which the solver starts; 0 = all. checked: every other row is
    // looked at in the answer and taken in where it is violated, until none is, which gives the optimum over
    // all rows.
    uint32_t first = 0;
    bool checked = true;
};

// How the proxy moves; fixed when it is made.
struct ProxyOptions {
    double stepCap = 0.002;       // [m] farthest that a leaf centre travels in one solve
    uint32_t solves = 4;          // linearisations a turn, at most
    double escapePerTurn = 0.001; // [m] depth given back in one turn where new data lies over the tool
    RowReduction rows;
};

// True when the turn should end: asked between solves, never in one. noexcept in practice: it is called on
// the turn.
struct Deadline {
    bool (*passed)(const void* context) = nullptr; // null = none
    const void* context = nullptr;
};

// What a turn asks of the proxy.
struct ProxyInput {
    Pose target;               // base_T_tool that the hand (and guidance) asks for
    double metricRadius = 0.1; // [m] k = sqrt(K_r / K_t)
    // The set in force, which must outlive the turn; null = the scene has no regions of points. Adopt a new
    // set only when Proxy::covers() it: otherwise spheres that neither set lists could lie between.
    const ContactSet* contacts = nullptr;
    Deadline deadline;
};

// A row that pushed in the last solve.
struct ActiveContact {
    ContactRow row;
    double multiplier = 0.0; // > 0, such that M (x - x_u) = sum of multiplier x row
};

// What became of it.
struct ProxyStep {
    Pose pose;                             // base_T_tool after the turn
    std::span<const ActiveContact> active; // valid until the next turn
    double minGap = 0.0;                   // [m] over the contact set; its certified reach if none is nearer
    bool contact = false;                  // active is not empty
    bool escape = false;                   // new data lies over the tool: some listed pair overlaps
    bool trapped = false;    // no motion obeys every row: held this turn, tried again at the next
    bool stalled = false;    // cut by the trust region: waits for the next contact set
    bool uncovered = false;  // the set given does not cover the tool (see ProxyInput::contacts)
    uint32_t solves = 0;     // linearisations
    uint32_t rounds = 0;     // solver calls with strengthened rows
    uint32_t infeasible = 0; // solver calls that found no motion
    uint32_t bisected = 0;   // steps that had to be shortened by the exact check
};

// One thread. Allocates in the constructor only; turn() is noexcept, never locks, throws or waits. The
// promise, kept by an exact check of every listed pair before a pose is taken: no pair's gap ends below
// min(0, its gap before), and on the straight way there neither. So a leaf never enters a sphere, and a depth
// that new data brought never grows. Exempt are pairs of a leaf flagged behind a surface that would hold it
// there (design 5, "Behind").
class Proxy {
public:
    Proxy(const Tool& tool, std::span<const Shape> shapes, const ProxyOptions& options, const Pose& start);

    ProxyStep step(const ProxyInput& input) noexcept;

    // May this set be put in force for the tool as it stands?
    bool covers(const ContactSet& contacts) noexcept;

    const Pose& pose() const { return pose_; }
    // Other shapes from the next turn on; as many as there were at first, or kSpareShapes if that is more. A
    // shape that comes to lie over the tool lets it out like new data.
    void setShapes(std::span<const Shape> shapes) noexcept;
    std::span<const Shape> shapes() const noexcept { return shapes_; }
    static constexpr size_t kSpareShapes = 16;

    // Puts the tool somewhere without any check (start of a run, arm re-indexed). A pose that is not finite
    // is ignored.
    void setPose(const Pose& pose) noexcept;

private:
    struct Budget {    // of one turn, all solves together
        double depth;  // [m] by which rows may ask touching pairs to part
        double travel; // [m] of leaf travel on account of that
    };
    struct Step {                 // what the solver answered and how much of it can be done
        Motion escape;            // least motion that obeys every row (zero unless some row asks for one)
        Motion full;              // nearest to the target
        double escapeShare = 0.0; // of `escape` that the caps leave
        double towards = 0.0;     // share from there to `full`
        double share = 0.0;       // of the result that the trust region leaves
        bool whole = false;       // the target itself, with nothing cut
    };

    // proxy_rows.cpp: the conditions at the present pose.
    void collectRows(const ContactSet* contacts, const Budget& budget) noexcept;
    void addPairRows(const ContactSet& contacts, const Budget& budget) noexcept;
    void addBehindRow(const ContactSet& contacts, uint32_t leaf, const Budget& budget) noexcept;
    void addShapeRows(const Budget& budget) noexcept;
    void addEqualityRows(const Shape& shape, uint32_t index, const Budget& budget) noexcept;
    bool addRow(ContactRow row) noexcept;
    double offsetFor(double gap, const Budget& budget) const noexcept;
    bool tighten(const Motion& tried, size_t violating, double share) noexcept;
    bool tightenShapes(double share) noexcept;

    // proxy_step.cpp: one linearisation.
    bool step(const ProxyInput& input, Budget& budget, ProxyStep& out) noexcept;
    bool solveRows(const Motion& wanted, Step& step, ProxyStep& out) noexcept;
    SolveStatus solveFor(const Motion& wanted, Motion& answer, ProxyStep& out) noexcept;
    // proxy_solve.cpp: the rows that the solver gets.
    void loadSolver(const Motion& wanted) noexcept;
    void loadRow(size_t row) noexcept;
    double offsetOf(size_t row) const noexcept;
    double violationAt(size_t row, const Motion& motion) const noexcept;
    bool loadViolated(const Motion& answer) noexcept;
    bool relax() noexcept;
    void fit(const ProxyInput& input, const Motion& wanted, const Budget& budget, Step& step) noexcept;
    static double answered(const Step& step) noexcept;
    double shareToCap(const Motion& first, const Motion& rest, double firstBound) noexcept;
    static Motion motionOf(const Step& step, double part) noexcept;
    void tryPose(const ProxyInput& input, const Step& step, double part) noexcept;
    bool isAllowed(const ContactSet* contacts, size_t& violating) noexcept;
    bool shapesAllow() noexcept;
    bool fitsExactly(const ProxyInput& input, const Motion& wanted, const Budget& budget, Step& step,
                     ProxyStep& out) noexcept;
    double bisect(const ProxyInput& input, const Step& step) noexcept;
    bool comesNearer(const Pose& target, const Motion& taken) const noexcept;
    void recordActive() noexcept;
    void setMetric(double radius) noexcept;

    LeafPlaces places_;
    std::vector<double> radius_; // of the leaves
    double boundingRadius_;
    std::vector<Shape> shapes_;
    ProxyOptions options_;
    Pose pose_;

    NarrowPhase narrow_;
    TrustRegion trust_;
    ConstraintSolver solver_;
    double metricRadius_ = 0.0;

    std::vector<ContactRow> rows_;
    size_t rowCount_ = 0;
    struct RowViolation {
        double amount; // [m]
        uint32_t row;
    };
    std::vector<RowViolation> rowViolations_; // room to choose rows in
    std::vector<uint32_t> loaded_;            // row of the solver -> row
    std::vector<uint8_t> isLoaded_;           // a row
    size_t loadedCount_ = 0;
    bool relaxed_ = false;      // rows that ask for no motion ask only to stay
    bool escaping_ = false;     // some row asks for motion
    double largestAsked_ = 0.0; // [m] of those rows
    bool touching_ = false;     // some pair overlaps
    bool firstSolve_ = true;    // of the turn
    std::vector<NarrowPhase::Violation> violations_;
    std::vector<dvec3> exempt_;     // a leaf: way to the camera while it is behind, else zero
    std::vector<double> clearance_; // a leaf: [m] left along it
    LeafCentres leaves_, next_;     // centres about the set's origin, now and at the pose tried
    Pose nextPose_;
    dvec3 origin_{0.0}; // [m] base frame: of the set in force
    std::array<ActiveContact, kMaxUnknowns> active_;
    size_t activeCount_ = 0;
};

} // namespace fathom
