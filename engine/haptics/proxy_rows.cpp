// SPDX-License-Identifier: Apache-2.0
#include "engine/haptics/proxy_rows.h"

#include <algorithm>

namespace fathom {

namespace {

constexpr double kViolation = 1e-12; // [m] smaller violations are rounding: far below the skin

} // namespace

ProxyRows::ProxyRows(size_t unknowns, const RowReduction& reduction)
    : unknowns_(unknowns)
    , reduction_(reduction)
    , solver_(static_cast<int>(unknowns), proxy::kMaxRows)
    , rows_(proxy::kMaxRows)
    , violations_(proxy::kMaxRows)
    , loaded_(proxy::kMaxRows)
    , isLoaded_(proxy::kMaxRows, 0) {}

void ProxyRows::clear() noexcept {
    count_ = loadedCount_ = 0;
    largestEscape_ = 0.0;
    solver_.clearRows();
}

bool ProxyRows::add(const ContactRow& row, std::span<const double> normal) noexcept {
    if (count_ == rows_.size()) {
        return false;
    }
    if (row.offset > proxy::kEscapeThreshold) {
        largestEscape_ = std::max(largestEscape_, row.offset);
    }
    rows_[count_].contact = row;
    std::copy_n(normal.begin(), unknowns_, rows_[count_++].normal.begin());
    return true;
}

ContactRow* ProxyRows::ofPair(uint32_t pair) noexcept {
    for (size_t i = 0; i < count_; ++i) {
        ContactRow& row = rows_[i].contact;
        if (row.kind == ContactRow::Kind::Sphere && row.pair == pair) {
            return &row;
        }
    }
    return nullptr;
}

// Present offset of the row.
double ProxyRows::offsetOf(size_t index) const noexcept {
    const ContactRow& row = rows_[index].contact;
    const bool stays = relaxed_ && row.gap >= 0.0 && row.offset <= proxy::kEscapeThreshold;
    return stays ? std::min(0.0, row.offset) : row.offset;
}

// [m] by which a motion [a; alpha] of a free tool falls short of a row; > 0 violates it.
double ProxyRows::violationAt(size_t row, std::span<const double> x) const noexcept {
    const auto& n = rows_[row].normal;
    return offsetOf(row) - glm::dot(dvec3(n[0], n[1], n[2]), dvec3(x[0], x[1], x[2])) -
           glm::dot(dvec3(n[3], n[4], n[5]), dvec3(x[3], x[4], x[5]));
}

void ProxyRows::loadRow(size_t index) noexcept {
    const Row& row = rows_[index];
    solver_.addRow({row.normal.data(), unknowns_}, offsetOf(index));
    solver_.setKey(loadedCount_, row.contact.key);
    isLoaded_[index] = 1;
    loaded_[loadedCount_++] = static_cast<uint32_t>(index);
}

void ProxyRows::load(std::span<const double> target) noexcept {
    relaxed_ = false;
    if (reduction_.first != 0 && reduction_.first < count_) {
        loadMostViolated(target);
        return;
    }
    for (size_t i = 0; i < loadedCount_; ++i) {
        solver_.setOffset(i, rows_[i].contact.offset);
    }
    while (loadedCount_ < count_) {
        loadRow(loadedCount_);
    }
}

void ProxyRows::loadMostViolated(std::span<const double> target) noexcept {
    solver_.clearRows();
    loadedCount_ = 0;
    for (size_t i = 0; i < count_; ++i) {
        isLoaded_[i] = 0;
        violations_[i] = {violationAt(i, target), static_cast<uint32_t>(i)};
    }
    const auto begin = violations_.begin(), middle = begin + reduction_.first;
    std::nth_element(begin, middle, begin + static_cast<std::ptrdiff_t>(count_),
                     [](const RowViolation& a, const RowViolation& b) {
                         return a.amount > b.amount || (a.amount == b.amount && a.row < b.row);
                     });
    std::for_each(begin, middle, [&](const RowViolation& violation) { loadRow(violation.row); });
}

bool ProxyRows::loadViolated(std::span<const double> x) noexcept {
    const size_t before = loadedCount_;
    for (size_t i = 0; reduction_.checked && before < count_ && i < count_; ++i) {
        if (isLoaded_[i] == 0 && !(violationAt(i, x) <= kViolation)) {
            loadRow(i);
        }
    }
    return loadedCount_ > before;
}

bool ProxyRows::relax() noexcept {
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

void ProxyRows::relaxAll() noexcept {
    for (size_t i = 0; i < loadedCount_; ++i) {
        double& offset = rows_[loaded_[i]].contact.offset;
        offset = std::min(0.0, offset);
        solver_.setOffset(i, offset);
    }
}

void ProxyRows::ignoreSpeeds() noexcept {
    for (size_t i = 0; i < count_; ++i) {
        ContactRow& row = rows_[i].contact;
        row.offset = row.kind == ContactRow::Kind::Joint ? row.gap : row.offset;
    }
}

void ProxyRows::recordActive() noexcept {
    activeCount_ = atLimits_ = atPositionLimits_ = 0;
    const std::span<const double> multipliers = solver_.multipliers();
    for (size_t i = 0; i < multipliers.size() && activeCount_ < active_.size(); ++i) {
        const ContactRow& row = rows_[loaded_[i]].contact;
        if (!(multipliers[i] > 0.0)) {
            continue;
        }
        if (row.kind == ContactRow::Kind::Joint) {
            ++atLimits_;
            atPositionLimits_ += row.offset <= row.gap ? 1 : 0; // not tightened by the joint's speed
        } else {
            active_[activeCount_++] = {row, multipliers[i]};
        }
    }
}

} // namespace fathom
