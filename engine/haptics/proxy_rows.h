// SPDX-License-Identifier: Apache-2.0
// The rows of one linearisation and their solver.
#pragma once

#include "engine/contact/contact_row.h"
#include "engine/contact/narrow_phase.h"
#include "engine/haptics/constraint_solver.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace fathom {

// Which rows a solve gets. No choice lets a leaf enter a region sphere, because the exact check tests every
// listed pair before a pose is accepted and a violated pair gets a row. A reduction can only cost lag.
struct RowReduction {
    double reach = 2.0; // pairs farther than this many step caps get no row; below 1 counts as 1
    // [rad] 0..pi/2: a leaf's row represents its farther pairs within this angle.
    double cone = NarrowPhase::kCone;
    // The solver starts with this many of the rows that the target violates most; 0 = all rows. Free tool
    // only. checked: add rows that the solution violates until none is left, which gives the optimum over all
    // rows.
    uint32_t first = 0;
    bool checked = true;
    // Leaves slide on smooth planes just outside of the spheres (smooth_plane.h), not over each sphere's top.
    bool smooth = false;
};

// A row with a positive multiplier in the last solve.
struct ActiveContact {
    ContactRow row;
    double multiplier = 0.0; // > 0, such that M (x - x_u) = sum of multiplier x row
};

namespace proxy {

// Rows keep this extra distance, so that the solver's rounding (about 1e-13 of the step) never fails the
// exact check, which has no tolerance.
inline constexpr double kSkin = 1e-9; // [m]
// Rows with a larger offset request motion (an escape). Well above the skin.
inline constexpr double kEscapeThreshold = 4e-9; // [m]
inline constexpr double kNegligible = 1e-9; // [m], [rad] shorter steps and shallower overlaps are ignored
inline constexpr size_t kMaxPairRows = 512;
inline constexpr size_t kMaxRows = 1280;  // the rest: shapes, joints, behind, and rows for violated pairs
inline constexpr size_t kSpareRows = 256; // that shapes leave to rows of violated pairs and shapes

} // namespace proxy

// One thread. Allocates in the constructor only; everything else is noexcept.
class ProxyRows {
public:
    ProxyRows(size_t unknowns, const RowReduction& reduction);

    void clear() noexcept;
    // normal: the row in the solver's unknowns. False when full.
    bool add(const ContactRow& row, std::span<const double> normal) noexcept;
    size_t size() const noexcept { return count_; }
    ContactRow& operator[](size_t row) noexcept { return rows_[row].contact; }
    ContactRow* ofPair(uint32_t pair) noexcept;                     // null = the pair has no row
    bool escaping() const noexcept { return largestEscape_ > 0.0; } // some row requests motion
    // [m] largest request of a row when added
    double largestEscape() const noexcept { return largestEscape_; }

    // n x n, as ConstraintSolver::setMetric(); must be positive definite.
    void setMetric(std::span<const double> metric) { solver_.setMetric(metric); }
    // Loads rows with their present offsets into the solver: all, or those that RowReduction selects.
    void load(std::span<const double> target) noexcept;
    // True when x is the optimum over the loaded rows.
    bool solve(std::span<const double> target, std::span<double> x) noexcept {
        return solver_.solve(target, x) == SolveStatus::Optimal;
    }
    // Loads every other row that the solution violates. False when there is none.
    bool loadViolated(std::span<const double> x) noexcept;
    // For walls that leave no room for the skin: rows that neither overlap nor escape only require the gap
    // not to shrink, until the next load(). False when this changes nothing.
    bool relax() noexcept;
    // For contradictory rows: every row only requires that its gap does not shrink, permanently.
    void relaxAll() noexcept;
    // Joint rows keep their position limit only (ContactRow::gap), until clear().
    void ignoreSpeeds() noexcept;

    // Contacts of the last recorded solve; joint rows are only counted.
    void recordActive() noexcept;
    void clearActive() noexcept { activeCount_ = 0; }
    std::span<const ActiveContact> active() const noexcept { return {active_.data(), activeCount_}; }
    uint32_t atLimits() const noexcept { return atLimits_; }
    // Active limits of joints: of position and of speed, and of position alone.
    uint32_t atPositionLimits() const noexcept { return atPositionLimits_; }

private:
    struct Row {
        ContactRow contact;
        std::array<double, kMaxUnknowns> normal;
    };
    struct RowViolation {
        double amount; // [m]
        uint32_t row;
    };
    void loadRow(size_t row) noexcept;
    void loadMostViolated(std::span<const double> target) noexcept;
    double offsetOf(size_t row) const noexcept;
    double violationAt(size_t row, std::span<const double> x) const noexcept;

    size_t unknowns_;
    RowReduction reduction_;
    ConstraintSolver solver_;
    std::vector<Row> rows_;
    size_t count_ = 0;
    double largestEscape_ = 0.0;
    bool relaxed_ = false;
    std::vector<RowViolation> violations_; // scratch
    std::vector<uint32_t> loaded_;         // row of the solver -> row
    std::vector<uint8_t> isLoaded_;        // per row
    size_t loadedCount_ = 0;
    std::array<ActiveContact, kMaxUnknowns> active_;
    size_t activeCount_ = 0;
    uint32_t atLimits_ = 0, atPositionLimits_ = 0;
};

} // namespace fathom
