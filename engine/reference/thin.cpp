// SPDX-License-Identifier: Apache-2.0
#include "engine/reference/thin.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <unordered_map>

namespace fathom::reference {

namespace {

struct ClassifiedPoints {
    int width, height;
    std::span<const int> classes;
    const PointImage& points;

    size_t index(int u, int v) const {
        return static_cast<size_t>(v) * static_cast<size_t>(width) + static_cast<size_t>(u);
    }
    int cls(int u, int v) const { return u < width && v < height ? classes[index(u, v)] : -1; }
    dvec3 at(int u, int v) const { return points.at[index(u, v)]; }
};

// Growth of the corners of the k x k cell at (u, v); -1 when it is not full of one class.
double cellGrowth(const Scene& scene, const ClassifiedPoints& p, int u, int v, int k) {
    const int c = p.cls(u, v);
    for (int dv = 0; dv <= k; ++dv) {
        for (int du = 0; du <= k; ++du) {
            if (c < 0 || p.cls(u + du, v + dv) != c) {
                return -1.0;
            }
        }
    }
    const double radius = regionRadius(scene, c);
    const std::array corners{p.at(u, v), p.at(u + k, v), p.at(u, v + k), p.at(u + k, v + k)};
    double growth = 0.0;
    for (int dv = 0; dv <= k; ++dv) {
        for (int du = 0; du <= k; ++du) {
            const double s = static_cast<double>(du) / k, t = static_cast<double>(dv) / k;
            const std::array weight{(1 - s) * (1 - t), s * (1 - t), (1 - s) * t, s * t};
            dvec3 mean(0.0);
            for (size_t i = 0; i < 4; ++i) {
                mean += weight[i] * corners[i];
            }
            double spread = 0.0;
            for (size_t i = 0; i < 4; ++i) {
                spread += weight[i] * glm::dot(corners[i] - mean, corners[i] - mean);
            }
            const double e = glm::distance(p.at(u + du, v + dv), mean);
            growth = std::max(growth, std::sqrt((radius + e) * (radius + e) + spread) - radius);
        }
    }
    return growth;
}

// Spheres hashed by cubes as wide as the largest diameter: every sphere that covers a point is in the 27
// cubes around it.
class SphereHash {
public:
    explicit SphereHash(std::span<const RegionSphere> spheres) {
        for (const RegionSphere& s : spheres) {
            edge_ = std::max(edge_, s.radius);
        }
        for (const RegionSphere& s : spheres) {
            if (s.radius >= 0.0) {
                cubes_[key(cubeOf(s.centre))].push_back(s);
            }
        }
    }

    // Distance to the union [m]; <= 0 when covered (stops at the first sphere that covers).
    double outside(const dvec3& p) const {
        const glm::i64vec3 centre = cubeOf(p);
        double nearest = HUGE_VAL;
        for (int64_t k = 0; k < 27; ++k) {
            const auto found = cubes_.find(
                key(centre + glm::i64vec3((k + 13) % 3 - 1, (k + 13) / 3 % 3 - 1, (k + 13) / 9 % 3 - 1)));
            for (size_t i = 0; found != cubes_.end() && i < found->second.size(); ++i) {
                const RegionSphere& s = found->second[i];
                nearest = std::min(nearest, glm::distance(s.centre, p) - s.radius);
                if (nearest <= 0.0) {
                    return nearest;
                }
            }
        }
        return nearest;
    }

private:
    glm::i64vec3 cubeOf(const dvec3& p) const { return glm::i64vec3(glm::floor(p / edge_)); }
    static uint64_t key(const glm::i64vec3& c) {
        return static_cast<uint64_t>(c.x & 0x1fffff) << 42 | static_cast<uint64_t>(c.y & 0x1fffff) << 21 |
               static_cast<uint64_t>(c.z & 0x1fffff);
    }
    double edge_ = 1e-6;
    std::unordered_map<uint64_t, std::vector<RegionSphere>> cubes_;
};

// Distance from `from` along a unit vector to where the ray leaves the last sphere.
double lastExit(std::span<const RegionSphere> spheres, const dvec3& from, const dvec3& along) {
    double exit = 0.0;
    for (const RegionSphere& s : spheres) {
        const dvec3 c = s.centre - from;
        const double middle = glm::dot(c, along),
                     half2 = s.radius * s.radius - (glm::dot(c, c) - middle * middle);
        if (half2 > 0.0 && middle + s.radius > exit) {
            exit = std::max(exit, middle + std::sqrt(half2));
        }
    }
    return exit;
}

} // namespace

std::vector<CellThinning> thin(const Scene& scene, int width, int height, std::span<const int> classes,
                               const PointImage& points) {
    const ClassifiedPoints p{width, height, classes, points};
    const double budget = scene.errorBudget;
    std::vector<CellThinning> cells;
    for (int v = 0; v < height; v += 4) {
        for (int u = 0; u < width; u += 4) {
            CellThinning& cell = cells.emplace_back();
            const auto decide = [&](double growth) {
                cell.unsure = cell.unsure || std::abs(growth - budget) < 1e-6;
                return growth >= 0.0 && growth <= budget ? growth : -1.0;
            };
            cell.whole = decide(cellGrowth(scene, p, u, v, 4));
            for (int q = 0; cell.whole < 0.0 && q < 4; ++q) {
                cell.quarters[static_cast<size_t>(q)] =
                    decide(cellGrowth(scene, p, u + q % 2 * 2, v + q / 2 * 2, 2));
            }
        }
    }
    return cells;
}

std::vector<double> keptGrowth(int width, int height, std::span<const CellThinning> cells) {
    const int across = (width + 3) / 4;
    static const CellThinning kUntouched;
    const auto cellOf = [&](int u, int v) -> const CellThinning& {
        return u < 0 || v < 0 ? kUntouched : cells[static_cast<size_t>(v / 4 * across + u / 4)];
    };
    const auto quarterOf = [&](int u, int v) {
        return u < 0 || v < 0 ? -1.0 : cellOf(u, v).quarters[static_cast<size_t>(v % 4 / 2 * 2 + u % 4 / 2)];
    };
    std::vector<double> growth(static_cast<size_t>(width) * static_cast<size_t>(height));
    for (int v = 0; v < height; ++v) {
        for (int u = 0; u < width; ++u) {
            double& g = growth[static_cast<size_t>(v * width + u)];
            if (u % 2 != 0 || v % 2 != 0) {
                g = cellOf(u, v).whole >= 0.0 || quarterOf(u, v) >= 0.0 ? -1.0 : 0.0;
                continue;
            }
            bool allWhole = true;
            for (const int dv :
                 {-1, 0}) { // the four pixels around the corner identify the cells that meet there
                for (const int du : {-1, 0}) {
                    const double whole = cellOf(u + du, v + dv).whole;
                    allWhole = allWhole && whole >= 0.0;
                    g = std::max({g, quarterOf(u + du, v + dv), u % 4 == 0 && v % 4 == 0 ? whole : 0.0});
                }
            }
            if (allWhole && (u % 4 != 0 || v % 4 != 0)) {
                g = -1.0;
            }
        }
    }
    return growth;
}

Coverage coverage(std::span<const RegionSphere> all, std::span<const RegionSphere> kept, uint32_t samples,
                  double tolerance, uint64_t seed) {
    std::vector<RegionSphere> sources;
    std::copy_if(all.begin(), all.end(), std::back_inserter(sources),
                 [](const RegionSphere& s) { return s.radius >= 0.0; });
    Coverage out;
    if (sources.empty()) {
        return out;
    }
    const SphereHash hash(kept);
    std::mt19937_64 random(seed);
    std::uniform_int_distribution<size_t> pick(0, sources.size() - 1);
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> unit;
    for (; out.samples < samples; ++out.samples) {
        const RegionSphere& s = sources[pick(random)];
        const dvec3 direction = glm::normalize(dvec3(normal(random), normal(random), normal(random)));
        const double inside = s.radius * (out.samples % 2 == 0 ? std::cbrt(unit(random)) : 1.0);
        const double along = out.samples % 4 == 0 ? lastExit(sources, s.centre, direction) - 1e-12 : inside;
        const double outside = hash.outside(s.centre + direction * along);
        out.worst = std::max(out.worst, outside);
        out.holes += outside > tolerance ? 1 : 0;
    }
    return out;
}

} // namespace fathom::reference
