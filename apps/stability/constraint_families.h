// SPDX-License-Identifier: Apache-2.0
// Families of random row sets for the solver: what a sphere tool meets, and what breaks solvers.
#pragma once

#include "apps/stability/rng.h"
#include "engine/reference/kkt.h"

#include <cstddef>
#include <span>
#include <vector>

namespace fathom::stability {

enum class RowFamily {
    Generic,       // normals any way, offsets any way: often infeasible
    Feasible,      // the same about a point that obeys all
    FlatWall,      // normals within 1e-3 of one
    Groove,        // two walls that open by 0.1 to 20 degrees
    Needle,        // normals all round an axis, arms along it
    Corner,        // three walls at right angles, with 1 % noise
    OpposingWalls, // exactly opposed normals, some leave no room
    Duplicates,    // half the rows are copies, some of them looser
    NearParallel,  // bundles of rows parallel to 1e-9
    Relief,        // a tool pressed on a rough surface: most rows are slack
};
inline constexpr size_t kRowFamilies = 10;
const char* nameOf(RowFamily family);

struct RowScale {
    double arm = 0.1;     // [m] half size of the tool
    double step = 0.01;   // [m] the hand is ahead by up to so much; offsets are a fifth of it
    double turn = 0.1;    // [rad]
    double radius = 0.05; // [m] gyration radius k of the metric diag(I, k^2 I)
};

// One nearest-point problem; rows are row-major.
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
    // [n, arm x n] . x >= offset
    void addContact(const dvec3& normalOut, const dvec3& arm, double offset);
};

RowSet makeRowSet(RowFamily family, size_t rows, const RowScale& scale, Rng& rng);

// Eight unknowns and a full metric A A^T + floor I (condition up to about 10 / floor): an arm's joint
// increments.
RowSet makeArmSet(size_t rows, double floor, Rng& rng);

// Rows that some point obeys with `margin` [m] to spare, or (feasible false) rows of which a positive
// combination asks for more than nothing can give: sum of w_i n_i = 0 and sum of w_i d_i = margin, sum of w_i
// = 1.
RowSet makeCertainSet(bool feasible, size_t rows, double margin, const RowScale& scale, Rng& rng);

} // namespace fathom::stability
