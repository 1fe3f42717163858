// SPDX-License-Identifier: Apache-2.0
#include "apps/register/board_corners.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <deque>
#include <glm/geometric.hpp>
#include <map>
#include <optional>
#include <utility>

namespace fathom {

namespace {

using glm::dvec2;

constexpr int kRing[16][2] = {{5, 0},  {5, 2},   {4, 4},   {2, 5},   {0, 5},  {-2, 5}, {-4, 4}, {-5, 2},
                              {-5, 0}, {-5, -2}, {-4, -4}, {-2, -5}, {0, -5}, {2, -5}, {4, -4}, {5, -2}};
constexpr int kMargin = 7;        // [pixels] from the image's edge
constexpr double kWeakest = 0.2;  // of the strongest response
constexpr double kOff = 0.35;     // of a square's edge: tolerance of a predicted corner
constexpr size_t kSeeds = 12;     // seed corners of grids
constexpr double kWindow = 2.0;   // [pixels] sigma of the quadric's weights
constexpr int kMinContrast = 160; // of the response: 10 grey levels at every sample

struct GreyView {
    std::span<const uint8_t> grey;
    int width, height;
    int at(int x, int y) const { return grey[static_cast<size_t>(y) * static_cast<size_t>(width) + x]; }
    double between(const dvec2& p) const {
        const int x = std::clamp(static_cast<int>(std::floor(p.x)), 0, width - 2);
        const int y = std::clamp(static_cast<int>(std::floor(p.y)), 0, height - 2);
        const double a = std::clamp(p.x - x, 0.0, 1.0), b = std::clamp(p.y - y, 0.0, 1.0);
        return (1 - b) * ((1 - a) * at(x, y) + a * at(x + 1, y)) +
               b * ((1 - a) * at(x, y + 1) + a * at(x + 1, y + 1));
    }
};

// Large where opposite samples agree and samples a quarter turn away differ.
int response(const GreyView& image, int x, int y) {
    std::array<int, 16> ring{};
    int sum = 0, across = 0, along = 0;
    for (size_t k = 0; k < 16; ++k) {
        sum += ring[k] = image.at(x + kRing[k][0], y + kRing[k][1]);
    }
    for (size_t k = 0; k < 4; ++k) {
        across += std::abs(ring[k] + ring[k + 8] - ring[k + 4] - ring[k + 12]);
    }
    for (size_t k = 0; k < 8; ++k) {
        along += std::abs(ring[k] - ring[k + 8]);
    }
    const int near =
        image.at(x, y) + image.at(x + 1, y) + image.at(x - 1, y) + image.at(x, y + 1) + image.at(x, y - 1);
    return across - along - std::abs(16 * near / 5 - sum);
}

// Stationary point of a quadric fitted to the image around `guess`.
std::optional<dvec2> saddle(const GreyView& image, dvec2 guess) {
    const dvec2 first = guess;
    for (int round = 0; round < 4; ++round) {
        Eigen::Matrix<double, 6, 6> normal = Eigen::Matrix<double, 6, 6>::Zero();
        Eigen::Matrix<double, 6, 1> right = Eigen::Matrix<double, 6, 1>::Zero();
        const int cx = static_cast<int>(std::lround(guess.x)), cy = static_cast<int>(std::lround(guess.y));
        for (int y = cy - 4; y <= cy + 4; ++y) {
            for (int x = cx - 4; x <= cx + 4; ++x) {
                const double u = x - guess.x, v = y - guess.y;
                const double weight = std::exp(-(u * u + v * v) / (2.0 * kWindow * kWindow));
                Eigen::Matrix<double, 6, 1> row;
                row << u * u, v * v, u * v, u, v, 1.0;
                normal += weight * row * row.transpose();
                right += weight * image.at(x, y) * row;
            }
        }
        const Eigen::Matrix<double, 6, 1> q = normal.ldlt().solve(right);
        const double determinant = 4.0 * q(0) * q(1) - q(2) * q(2);
        if (!(determinant < 0.0)) { // no saddle
            return std::nullopt;
        }
        guess += dvec2(q(2) * q(4) - 2.0 * q(1) * q(3), q(2) * q(3) - 2.0 * q(0) * q(4)) / determinant;
        if (!(glm::distance(guess, first) < 2.5)) {
            return std::nullopt;
        }
    }
    return guess;
}

std::vector<dvec2> saddles(const GreyView& image, size_t most) {
    struct Peak {
        int strength, x, y;
    };
    std::vector<int> field(image.grey.size(), 0);
    const auto at = [&](int x, int y) -> int& {
        return field[static_cast<size_t>(y) * static_cast<size_t>(image.width) + x];
    };
    int strongest = kMinContrast;
    for (int y = kMargin; y < image.height - kMargin; ++y) {
        for (int x = kMargin; x < image.width - kMargin; ++x) {
            at(x, y) = response(image, x, y);
            strongest = std::max(strongest, at(x, y));
        }
    }
    std::vector<Peak> peaks;
    for (int y = kMargin; y < image.height - kMargin; ++y) {
        for (int x = kMargin; x < image.width - kMargin; ++x) {
            bool peak = at(x, y) >= std::max(kMinContrast, static_cast<int>(kWeakest * strongest));
            for (int dy = -4; dy <= 4 && peak; ++dy) {
                for (int dx = -4; dx <= 4 && peak; ++dx) {
                    const int other = at(x + dx, y + dy);
                    peak = other < at(x, y) || (other == at(x, y) && (dy > 0 || (dy == 0 && dx >= 0)));
                }
            }
            if (peak) {
                peaks.push_back({at(x, y), x, y});
            }
        }
    }
    std::ranges::sort(peaks, std::greater{}, &Peak::strength);
    std::vector<dvec2> found;
    for (size_t i = 0; i < std::min(most, peaks.size()); ++i) {
        if (const auto place = saddle(image, {peaks[i].x, peaks[i].y})) {
            found.push_back(*place);
        }
    }
    return found;
}

using Cell = std::pair<int, int>; // column, row; any origin

struct Grown {
    dvec2 place, right, down;
};

// Nearest of the points for which `may` holds; its index.
template <class May>
std::optional<size_t> nearest(const std::vector<dvec2>& points, const dvec2& to, double within, May&& may) {
    std::optional<size_t> best;
    for (size_t i = 0; i < points.size(); ++i) {
        const double away = glm::distance(points[i], to);
        if (away < within && may(i)) {
            within = away;
            best = i;
        }
    }
    return best;
}

// Grows a grid from one corner; each neighbour is predicted from the squares around it.
std::map<Cell, Grown> grow(const std::vector<dvec2>& points, size_t seed) {
    const dvec2 origin = points[seed];
    const auto side = nearest(points, origin, 1e9, [&](size_t i) { return i != seed; });
    if (!side) {
        return {};
    }
    const dvec2 right = points[*side] - origin;
    const auto below = nearest(points, origin, 2.0 * glm::length(right), [&](size_t i) {
        const dvec2 way = points[i] - origin;
        return i != seed && std::abs(glm::dot(way, right)) < 0.5 * glm::length(way) * glm::length(right);
    });
    if (!below) {
        return {};
    }
    std::map<Cell, Grown> grid{{{0, 0}, {origin, right, points[*below] - origin}}};
    std::vector<bool> used(points.size(), false);
    used[seed] = true;
    for (std::deque<Cell> open{{0, 0}}; !open.empty(); open.pop_front()) {
        const Cell cell = open.front();
        const Grown here = grid.at(cell);
        for (const auto& [dx, dy] : {Cell{1, 0}, Cell{-1, 0}, Cell{0, 1}, Cell{0, -1}}) {
            const Cell next{cell.first + dx, cell.second + dy};
            const dvec2 step = static_cast<double>(dx) * here.right + static_cast<double>(dy) * here.down;
            const auto found = nearest(points, here.place + step, kOff * glm::length(step),
                                       [&](size_t i) { return !used[i]; });
            if (!found || grid.count(next) != 0) {
                continue;
            }
            used[*found] = true;
            Grown grown{points[*found], here.right, here.down};
            (dx != 0 ? grown.right : grown.down) =
                static_cast<double>(dx + dy) * (points[*found] - here.place);
            grid.emplace(next, grown);
            open.push_back(next);
        }
    }
    return grid;
}

// Row by row, when the grid is complete and of that size, in either orientation.
std::vector<dvec2> rowByRow(const std::map<Cell, Grown>& grid, int columns, int rows) {
    if (grid.size() != static_cast<size_t>(columns) * static_cast<size_t>(rows)) {
        return {};
    }
    Cell low = grid.begin()->first, high = low;
    for (const auto& [cell, grown] : grid) {
        low = {std::min(low.first, cell.first), std::min(low.second, cell.second)};
        high = {std::max(high.first, cell.first), std::max(high.second, cell.second)};
    }
    const int wide = high.first - low.first + 1, tall = high.second - low.second + 1;
    const bool lying = wide == rows && tall == columns;
    if (!lying && !(wide == columns && tall == rows)) {
        return {};
    }
    std::vector<dvec2> corners;
    for (int j = 0; j < rows; ++j) {
        for (int i = 0; i < columns; ++i) {
            corners.push_back(grid.at({low.first + (lying ? j : i), low.second + (lying ? i : j)}).place);
        }
    }
    return corners;
}

// Reorders to a right-handed grid that starts at the corner whose outer square is dark.
void putUpright(const GreyView& image, std::vector<dvec2>& corners, size_t columns) {
    const dvec2 right = corners[1] - corners[0], down = corners[columns] - corners[0];
    if (right.x * down.y - right.y * down.x < 0.0) {
        for (size_t row = 0; row < corners.size(); row += columns) {
            const auto begin = corners.begin() + static_cast<std::ptrdiff_t>(row);
            std::reverse(begin, begin + static_cast<std::ptrdiff_t>(columns));
        }
    }
    const size_t last = corners.size() - 1;
    const dvec2 begin = 0.5 * (corners[1] - corners[0]) + 0.5 * (corners[columns] - corners[0]);
    const dvec2 end =
        0.5 * (corners[last] - corners[last - 1]) + 0.5 * (corners[last] - corners[last - columns]);
    if (image.between(corners[0] - begin) > image.between(corners[last] + end)) {
        std::ranges::reverse(corners);
    }
}

} // namespace

std::vector<glm::dvec2> boardCorners(std::span<const uint8_t> grey, uint32_t width, uint32_t height,
                                     uint32_t columns, uint32_t rows) {
    const GreyView image{grey, static_cast<int>(width), static_cast<int>(height)};
    const std::vector<dvec2> points = saddles(image, 4 * size_t{columns} * rows + 64);
    for (size_t seed = 0; seed < std::min(kSeeds, points.size()); ++seed) {
        std::vector<dvec2> corners =
            rowByRow(grow(points, seed), static_cast<int>(columns), static_cast<int>(rows));
        if (!corners.empty()) {
            putUpright(image, corners, columns);
            return corners;
        }
    }
    return {};
}

} // namespace fathom
