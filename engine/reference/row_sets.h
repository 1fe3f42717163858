// SPDX-License-Identifier: Apache-2.0
// Random sets of constraint rows for the solver, in families: typical contacts of a sphere tool, and known
// hard cases.
#pragma once

#include "engine/reference/kkt.h"
#include "engine/reference/rng.h"

#include <cstddef>
#include <span>
#include <vector>

namespace fathom {

enum class RowFamily {
    Generic,       // random normals and offsets: often infeasible
    Feasible,      // random normals, but one point satisfies all rows
    FlatWall,      // normals within 1e-3 of each other
    Groove,        // two walls with an opening angle of 0.1 to 20 degrees
    Needle,        // normals all around an axis, arms along it
    Corner,        // three walls at right angles, with 1 % noise
    OpposingWalls, // exactly opposed normals, some infeasible
    Duplicates,    // half of the rows are copies, some of them looser
    NearParallel,  // bundles of rows parallel to 1e-9
    Relief,        // a tool pressed on a rough surface: most rows are slack
};
inline constexpr size_t kRowFamilies = 10;
const char* nameOf(RowFamily family);

struct RowScale {
    double arm = 0.1;     // [m] half size of the tool
    double step = 0.01;   // [m] largest lead of the hand; offsets are up to a fifth of it
    double turn = 0.1;    // [rad] largest rotation of the hand
    double radius = 0.05; // [m] gyration radius k of the metric diag(I, k^2 I)
    size_t unknowns = 6;  // 3: translations only
};

// One nearest-point problem. The rows are stored row-major.
struct RowSet {
    size_t unknowns = 6;
    std::vector<double> metric, target, normals, offsets;

    size_t rows() const { return offsets.size(); }
    std::span<const double> normal(size_t row) const {
        return std::span(normals).subspan(row * unknowns, unknowns);
    }
    NearestPointProblem problem() const { return {unknowns, metric, target, normals, offsets}; }
    void add(std::span<const double> row, double offset) {
        normals.insert(normals.end(), row.begin(), row.end());
        offsets.push_back(offset);
    }
    // row: [n, arm x n] . x >= offset, without the moment when there are 3 unknowns
    void addContact(const dvec3& normalOut, const dvec3& arm, double offset);
};

// diag(I, radius^2 I) of a free tool.
std::vector<double> toolMetric(size_t unknowns, double radius);

RowSet makeRowSet(RowFamily family, size_t rows, const RowScale& scale, Rng& rng);

// Rows over an arm's joint increments: `unknowns` of them and a full metric A A^T + floor I, with a condition
// number up to about 10 / floor.
RowSet makeArmSet(size_t unknowns, size_t rows, double floor, Rng& rng);

// Rows with a known answer. Feasible: some point satisfies all rows by at least `margin` [m]. Infeasible by a
// Farkas certificate: positive weights with sum(w_i) = 1, sum(w_i n_i) = 0 and sum(w_i d_i) = margin.
RowSet makeCertainSet(bool feasible, size_t rows, double margin, const RowScale& scale, Rng& rng);

} // namespace fathom
