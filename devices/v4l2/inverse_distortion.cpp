// SPDX-License-Identifier: Apache-2.0
#include "devices/v4l2/inverse_distortion.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace fathom {

namespace {

using Row = std::array<double, 6>; // five columns and the right-hand side

// What each coefficient adds at p: dx and dy by k1 k2 p1 p2 k3.
std::pair<std::array<double, 5>, std::array<double, 5>> shares(const glm::dvec2& p) {
    const double r2 = p.x * p.x + p.y * p.y, xy = p.x * p.y;
    return {{p.x * r2, p.x * r2 * r2, 2.0 * xy, r2 + 2.0 * p.x * p.x, p.x * r2 * r2 * r2},
            {p.y * r2, p.y * r2 * r2, r2 + 2.0 * p.y * p.y, 2.0 * xy, p.y * r2 * r2 * r2}};
}

glm::dvec2 displaced(const glm::dvec2& p, const std::array<double, 5>& k) {
    const auto [dx, dy] = shares(p);
    glm::dvec2 out = p;
    for (size_t i = 0; i < 5; ++i) {
        out += k[i] * glm::dvec2(dx[i], dy[i]);
    }
    return out;
}

// Gauss with row pivots.
std::array<double, 5> solve(std::array<Row, 5> m) {
    for (size_t c = 0; c < 5; ++c) {
        const auto pivot =
            std::max_element(m.begin() + static_cast<long>(c), m.end(),
                             [c](const Row& a, const Row& b) { return std::abs(a[c]) < std::abs(b[c]); });
        std::swap(*pivot, m[c]);
        for (size_t r = 0; r < 5; ++r) {
            const double factor = r == c ? 0.0 : m[r][c] / m[c][c];
            for (size_t i = c; i < 6; ++i) {
                m[r][i] -= factor * m[c][i];
            }
        }
    }
    std::array<double, 5> x{};
    for (size_t i = 0; i < 5; ++i) {
        x[i] = m[i][5] / m[i][i];
    }
    return x;
}

} // namespace

std::array<double, 5> forwardDistortion(const Intrinsics& lens, const std::array<double, 5>& undistorting) {
    if (undistorting == std::array<double, 5>{}) {
        return {};
    }
    constexpr int kSteps = 24;
    std::array<Row, 5> normal{};
    for (int i = 0; i <= kSteps; ++i) {
        for (int j = 0; j <= kSteps; ++j) {
            const glm::dvec2 seen((lens.width * (i / double{kSteps}) - lens.cx) / lens.fx,
                                  (lens.height * (j / double{kSteps}) - lens.cy) / lens.fy);
            const glm::dvec2 straight = displaced(seen, undistorting), missing = seen - straight;
            const auto [dx, dy] = shares(straight);
            for (size_t r = 0; r < 5; ++r) {
                for (size_t c = 0; c < 5; ++c) {
                    normal[r][c] += dx[r] * dx[c] + dy[r] * dy[c];
                }
                normal[r][5] += dx[r] * missing.x + dy[r] * missing.y;
            }
        }
    }
    return solve(normal);
}

} // namespace fathom
