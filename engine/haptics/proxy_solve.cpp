// SPDX-License-Identifier: Apache-2.0
// The solver's answer over the rows of a linearisation: over all of them at once, or over few with a look at
// the rest.
#include "engine/haptics/proxy.h"

#include "engine/haptics/proxy_limits.h"

#include <algorithm>

namespace fathom {

namespace {

constexpr double kViolation =
    1e-12; // [m] a row that lacks less is obeyed: far below the skin that rows ask for

} // namespace

// What the row asks for now.
double Proxy::offsetOf(size_t row) const noexcept {
    const bool stays = relaxed_ && rows_[row].gap >= 0.0 && rows_[row].offset <= proxy::kEscapeThreshold;
    return stays ? std::min(0.0, rows_[row].offset) : rows_[row].offset;
}

// [m] by which a motion falls short of a row; > 0 violates it.
double Proxy::violationAt(size_t row, const Motion& motion) const noexcept {
    const ContactRow& r = rows_[row];
    return offsetOf(row) - glm::dot(r.normal, motion.a) -
           glm::dot(glm::cross(r.arm, r.normal) + r.spin, motion.alpha);
}

void Proxy::loadRow(size_t index) noexcept {
    const ContactRow& row = rows_[index];
    const dvec3 turning = glm::cross(row.arm, row.normal) + row.spin;
    const std::array<double, 6> normal{row.normal.x, row.normal.y, row.normal.z,
                                       turning.x,    turning.y,    turning.z};
    solver_.addRow(normal, offsetOf(index));
    solver_.setKey(loadedCount_, row.key);
    isLoaded_[index] = 1;
    loaded_[loadedCount_++] = static_cast<uint32_t>(index);
}

void Proxy::loadSolver(const Motion& wanted) noexcept {
    solver_.clearRows();
    loadedCount_ = 0;
    relaxed_ = false;
    const size_t first = options_.rows.first;
    if (first == 0 || first >= rowCount_) {
        for (size_t i = 0; i < rowCount_; ++i) {
            loadRow(i);
        }
        return;
    }
    for (size_t i = 0; i < rowCount_; ++i) {
        isLoaded_[i] = 0;
        rowViolations_[i] = {violationAt(i, wanted), static_cast<uint32_t>(i)};
    }
    const auto begin = rowViolations_.begin(), middle = begin + static_cast<std::ptrdiff_t>(first);
    std::nth_element(begin, middle, begin + static_cast<std::ptrdiff_t>(rowCount_),
                     [](const RowViolation& a, const RowViolation& b) {
                         return a.amount > b.amount || (a.amount == b.amount && a.row < b.row);
                     });
    std::for_each(begin, middle, [&](const RowViolation& rowViolation) { loadRow(rowViolation.row); });
}

// Takes in every row that the answer violates and the solver did not have. False when there is none.
bool Proxy::loadViolated(const Motion& answer) noexcept {
    const size_t before = loadedCount_;
    for (size_t i = 0; before < rowCount_ && i < rowCount_; ++i) {
        if (isLoaded_[i] == 0 && !(violationAt(i, answer) <= kViolation)) {
            loadRow(i);
        }
    }
    return loadedCount_ > before;
}

// Between walls that leave no room for the skin: those that do not overlap stay where they are instead.
bool Proxy::relax() noexcept {
    if (relaxed_) {
        return false;
    }
    relaxed_ = true;
    bool changed = false;
    for (size_t i = 0; i < loadedCount_; ++i) {
        const double offset = offsetOf(loaded_[i]);
        changed = changed || offset != solver_.offset(i);
        solver_.setOffset(i, offset);
    }
    return changed;
}

SolveStatus Proxy::solveFor(const Motion& wanted, Motion& answer, ProxyStep& out) noexcept {
    const std::array<double, 6> target{wanted.a.x,     wanted.a.y,     wanted.a.z,
                                       wanted.alpha.x, wanted.alpha.y, wanted.alpha.z};
    std::array<double, 6> x{};
    SolveStatus status = SolveStatus::Optimal;
    do {
        status = solver_.solve(target, x);
        if (status != SolveStatus::Optimal && relax()) {
            status = solver_.solve(target, x);
        }
        answer = {dvec3(x[0], x[1], x[2]), dvec3(x[3], x[4], x[5])};
    } while (status == SolveStatus::Optimal && options_.rows.checked && loadViolated(answer));
    out.infeasible += status == SolveStatus::Optimal ? 0 : 1;
    return status;
}

bool Proxy::solveRows(const Motion& wanted, Step& step, ProxyStep& out) noexcept {
    loadSolver(wanted);
    Step answer;
    if (escaping_ && solveFor(Motion{}, answer.escape, out) != SolveStatus::Optimal) {
        return false;
    }
    if (solveFor(wanted, answer.full, out) != SolveStatus::Optimal) {
        return false;
    }
    step = answer;
    recordActive();
    return true;
}

void Proxy::recordActive() noexcept {
    activeCount_ = 0;
    const std::span<const double> multipliers = solver_.multipliers();
    for (size_t i = 0; i < multipliers.size() && activeCount_ < active_.size(); ++i) {
        if (multipliers[i] > 0.0) {
            active_[activeCount_++] = {rows_[loaded_[i]], multipliers[i]};
        }
    }
}

} // namespace fathom
