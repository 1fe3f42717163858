// SPDX-License-Identifier: Apache-2.0
#include "engine/reference/row_sets.h"

#include "engine/types/angle.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace fathom {

namespace {

struct Draft {         // parameters shared by all rows of a set
    double lean = 0.0; // [rad] tilt of a groove's wall from vertical
    std::array<dvec3, 4> bundles;
    std::vector<double> inside; // a point that satisfies all rows of a feasible set
};

Draft draft(const RowScale& scale, Rng& rng) {
    Draft d;
    d.lean = 0.5 * kDegree * rng.logUniform(0.1, 20.0);
    for (dvec3& axis : d.bundles) {
        axis = rng.direction();
    }
    for (int i = 0; i < 6; ++i) {
        d.inside.push_back(rng.uniform(-0.1, 0.1) * (i < 3 ? scale.step : scale.turn));
    }
    return d;
}

double along(std::span<const double> row, std::span<const double> x) {
    double sum = 0.0;
    for (size_t i = 0; i < row.size(); ++i) {
        sum += row[i] * x[i];
    }
    return sum;
}

void addRow(RowSet& set, RowFamily family, size_t index, const RowScale& scale, const Draft& draft,
            Rng& rng) {
    const dvec3 noise = rng.direction();
    const dvec3 arm = rng.inCube(scale.arm);
    const double gap = rng.uniform(-0.2, 0.05) * scale.step;
    const double side = index % 2 == 0 ? 1.0 : -1.0;
    switch (family) {
    case RowFamily::FlatWall:
        set.addContact(glm::normalize(dvec3(0, 0, 1) + 1e-3 * noise), arm, gap);
        break;
    case RowFamily::Groove:
        set.addContact({side * std::cos(draft.lean), 0.0, std::sin(draft.lean)}, {0.0, arm.y, 0.0}, gap);
        break;
    case RowFamily::Needle: {
        const double angle = rng.uniform(0.0, kTurn);
        set.addContact(glm::normalize(dvec3(std::cos(angle), std::sin(angle), 0.01 * noise.z)),
                       {0.0, 0.0, arm.z}, gap);
        break;
    }
    case RowFamily::Corner: {
        dvec3 axis(0.0);
        axis[static_cast<int>(index % 3)] = 1.0;
        set.addContact(glm::normalize(axis + 0.01 * noise), arm, gap);
        break;
    }
    case RowFamily::OpposingWalls:
        set.addContact({0.0, 0.0, side}, dvec3(0.0), index % 4 == 3 ? gap : -std::abs(gap));
        break;
    case RowFamily::NearParallel:
        set.addContact(glm::normalize(draft.bundles[index % 4] + 1e-9 * noise),
                       0.1 * scale.arm * draft.bundles[0], gap);
        break;
    case RowFamily::Relief:
        set.addContact(glm::normalize(dvec3(0, 0, 1) + 0.5 * noise), arm,
                       index < 3 ? 0.0 : -2.0 * std::abs(gap));
        break;
    default:
        set.addContact(noise, arm, gap);
        break;
    }
}

void addCopy(RowSet& set, double looser, Rng& rng) {
    const size_t copied = rng.below(set.rows());
    const auto row = set.normal(copied);
    const std::vector<double> twin(row.begin(), row.end());
    set.add(twin, set.offsets[copied] - (rng.chance(0.5) ? 0.0 : looser));
}

RowSet emptyRowSet(const RowScale& scale, Rng& rng) {
    RowSet set;
    set.unknowns = scale.unknowns;
    set.metric = toolMetric(set.unknowns, scale.radius);
    for (size_t i = 0; i < set.unknowns; ++i) {
        set.target.push_back(rng.uniform(-1.0, 1.0) * (i < 3 ? scale.step : scale.turn));
    }
    return set;
}

} // namespace

const char* nameOf(RowFamily family) {
    constexpr std::array<const char*, kRowFamilies> kNames{
        "generic", "feasible",       "flat-wall",  "groove",        "needle",
        "corner",  "opposing-walls", "duplicates", "near-parallel", "relief"};
    return kNames[static_cast<size_t>(family)];
}

void RowSet::addContact(const dvec3& normalOut, const dvec3& arm, double offset) {
    const dvec3 moment = glm::cross(arm, normalOut);
    const std::array<double, 6> row{normalOut.x, normalOut.y, normalOut.z, moment.x, moment.y, moment.z};
    add(std::span(row).first(unknowns), offset);
}

std::vector<double> toolMetric(size_t unknowns, double radius) {
    std::vector<double> metric(unknowns * unknowns, 0.0);
    for (size_t i = 0; i < unknowns; ++i) {
        metric[i * (unknowns + 1)] = i < 3 ? 1.0 : radius * radius;
    }
    return metric;
}

RowSet makeRowSet(RowFamily family, size_t rows, const RowScale& scale, Rng& rng) {
    RowSet set = emptyRowSet(scale, rng);
    const Draft shared = draft(scale, rng);
    while (set.rows() < rows) {
        const size_t index = set.rows();
        if (family == RowFamily::Duplicates && index > 0 && rng.chance(0.5)) {
            addCopy(set, 0.01 * scale.step, rng);
            continue;
        }
        addRow(set, family, index, scale, shared, rng);
        if (family == RowFamily::Feasible || family == RowFamily::Duplicates) {
            set.offsets.back() = along(set.normal(index), shared.inside) - rng.uniform(0.0, 0.1) * scale.step;
        }
    }
    return set;
}

RowSet makeArmSet(size_t unknowns, size_t rows, double floor, Rng& rng) {
    RowSet set;
    set.unknowns = unknowns;
    std::vector<double> a(unknowns * unknowns);
    for (double& value : a) {
        value = rng.normal();
    }
    set.metric.assign(unknowns * unknowns, 0.0);
    for (size_t i = 0; i < unknowns; ++i) {
        for (size_t j = 0; j <= i; ++j) {
            double sum = i == j ? floor : 0.0;
            for (size_t k = 0; k < unknowns; ++k) {
                sum += a[i * unknowns + k] * a[j * unknowns + k];
            }
            set.metric[i * unknowns + j] = set.metric[j * unknowns + i] = sum;
        }
    }
    std::vector<double> row(unknowns), inside(unknowns);
    for (size_t i = 0; i < unknowns; ++i) {
        set.target.push_back(rng.uniform(-0.1, 0.1));
        inside[i] = rng.uniform(-0.01, 0.01);
    }
    while (set.rows() < rows) {
        for (double& value : row) {
            value = rng.normal();
        }
        set.add(row, along(row, inside) - rng.uniform(-0.002, 0.02));
    }
    return set;
}

RowSet makeCertainSet(bool feasible, size_t rows, double margin, const RowScale& scale, Rng& rng) {
    RowSet set = emptyRowSet(scale, rng);
    const Draft shared = draft(scale, rng);
    while (set.rows() < rows) {
        set.addContact(rng.direction(), rng.inCube(scale.arm), 0.0);
        set.offsets.back() =
            along(set.normal(set.rows() - 1), shared.inside) - margin - rng.uniform(0.0, 0.1) * scale.step;
    }
    if (feasible) {
        return set;
    }
    // The last row contradicts up to five others: n = -sum(w_i n_i), d = margin - sum(w_i d_i).
    std::vector<double> last(6, 0.0);
    double offset = margin;
    const size_t others = std::min<size_t>(rows - 1, 1 + rng.below(5));
    for (size_t k = 0; k < others; ++k) {
        const double weight = rng.uniform(0.1, 1.0);
        for (size_t i = 0; i < 6; ++i) {
            last[i] -= weight * set.normal(k)[i];
        }
        offset -= weight * set.offsets[k];
    }
    std::copy(last.begin(), last.end(), set.normals.end() - 6);
    set.offsets.back() = offset;
    return set;
}

} // namespace fathom
