// SPDX-License-Identifier: Apache-2.0
#include "apps/register/robust_fit.h"

#include "engine/types/median.h"
#include "engine/types/printed.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <random>

namespace fathom {

namespace {

using Pairs = std::span<const PointPair>;

constexpr double kFar = 50.0;          // [m] as far as no depth camera measures
constexpr size_t kAllTriples = 20;     // pairs up to which every triple is tried
constexpr int kTriples = 1500;         // tried of more pairs
constexpr double kMinTolerance = 5e-3; // [m] a hand-held probe is no better
constexpr double kMaxScale = 0.03;     // relative difference of distances
constexpr size_t kWorst = 3;           // pairs named
constexpr double kMaxTurn = 0.05; // [rad] of the rotation's uncertainty; points on a line give 0.1 or more

double distanceOf(const Pose& pose, const PointPair& pair) {
    return glm::distance(pose.apply(pair.camera), pair.base);
}

// The rank-th smallest distance; rank from 0.
double rankedDistance(const Pose& pose, Pairs pairs, size_t rank) {
    std::vector<double> distances;
    for (const PointPair& pair : pairs) {
        distances.push_back(distanceOf(pose, pair));
    }
    std::nth_element(distances.begin(), distances.begin() + static_cast<std::ptrdiff_t>(rank),
                     distances.end());
    return distances[rank];
}

struct Consensus {
    Pose pose;
    double distance = HUGE_VAL; // [m] within which just over half of the pairs lie
};

class Search {
public:
    explicit Search(Pairs pairs)
        : pairs_(pairs)
        , rank_(std::min(pairs.size() - 1, pairs.size() / 2 + 2) - 1) {}

    Consensus run() {
        const size_t n = pairs_.size();
        if (n <= kAllTriples) {
            for (size_t i = 0; i < n; ++i) {
                for (size_t j = 0; j < i; ++j) {
                    for (size_t k = 0; k < j; ++k) {
                        attempt(i, j, k);
                    }
                }
            }
            return best_;
        }
        std::mt19937 random(1);
        std::uniform_int_distribution<size_t> any(0, n - 1);
        for (int i = 0; i < kTriples; ++i) {
            const size_t a = any(random), b = any(random), c = any(random);
            attempt(a, b, c);
        }
        return best_;
    }

private:
    void attempt(size_t i, size_t j, size_t k) {
        const PointPair triple[3] = {pairs_[i], pairs_[j], pairs_[k]};
        const dvec3 side = triple[1].base - triple[0].base, other = triple[2].base - triple[0].base;
        const double longest = std::max(glm::length(side), glm::length(other));
        if (!(glm::length(glm::cross(side, other)) > 1e-2 * longest * longest)) {
            return; // equal or on one line
        }
        const Pose pose = poseOf(triple);
        const double distance = rankedDistance(pose, pairs_, rank_);
        if (distance < best_.distance) {
            best_ = {pose, distance};
        }
    }

    Pairs pairs_;
    size_t rank_;
    Consensus best_;
};

// Median ratio of distances in the base to those in the camera, over points that are far apart.
double scaleOf(Pairs pairs) {
    const size_t stride = std::max<size_t>(1, pairs.size() / 60);
    double longest = 0.0;
    std::vector<std::pair<double, double>> sides; // base, camera
    for (size_t i = 0; i < pairs.size(); i += stride) {
        for (size_t j = 0; j < i; j += stride) {
            sides.emplace_back(glm::distance(pairs[i].base, pairs[j].base),
                               glm::distance(pairs[i].camera, pairs[j].camera));
            longest = std::max(longest, sides.back().first);
        }
    }
    std::vector<double> ratios;
    for (const auto& [base, camera] : sides) {
        if (base > 0.3 * longest && camera > 0.0) {
            ratios.push_back(base / camera);
        }
    }
    return ratios.empty() ? 1.0 : medianOf(ratios);
}

std::vector<PointPair> mirrored(Pairs pairs) {
    std::vector<PointPair> all(pairs.begin(), pairs.end());
    for (PointPair& pair : all) {
        pair.camera.x = -pair.camera.x;
    }
    return all;
}

// The pairs farthest from a pose, farthest first.
std::vector<RobustFit::Outlier> farthest(Pairs pairs, const Pose& pose, double beyond) {
    std::vector<RobustFit::Outlier> all;
    for (const PointPair& pair : pairs) {
        const double distance = distanceOf(pose, pair);
        if (distance > beyond) {
            all.push_back({pair.name, distance});
        }
    }
    std::ranges::stable_sort(all, [](const auto& a, const auto& b) { return a.distance > b.distance; });
    return all;
}

std::vector<PointPair> believed(Pairs pairs, const Pose& pose, double tolerance) {
    std::vector<PointPair> inliers;
    for (const PointPair& pair : pairs) {
        if (distanceOf(pose, pair) <= tolerance) {
            inliers.push_back(pair);
        }
    }
    return inliers;
}

// Each of them once: pairs of several frames have the same name.
std::string named(const std::vector<RobustFit::Outlier>& worst) {
    std::vector<std::string> names;
    std::string text = "; worst";
    for (size_t i = 0; i < worst.size() && names.size() < kWorst; ++i) {
        if (std::ranges::find(names, worst[i].name) == names.end()) {
            text +=
                (names.empty() ? " " : ", ") + worst[i].name + printed(" %.3g mm", 1e3 * worst[i].distance);
            names.push_back(worst[i].name);
        }
    }
    return worst.empty() ? "" : text;
}

// Whether the mirror image fits far better: by consensus, or all pairs at once, as a plane among the pairs
// fits either way.
bool isMirrored(Pairs pairs, const Consensus& found) {
    constexpr double kBetter = 0.3;
    const std::vector<PointPair> image = mirrored(pairs);
    const double plain = rankedDistance(poseOf(pairs), pairs, pairs.size() - 1);
    return (plain > kMinTolerance &&
            rankedDistance(poseOf(image), image, image.size() - 1) < kBetter * plain) ||
           (found.distance > kMinTolerance && Search(image).run().distance < kBetter * found.distance);
}

double rootMeanSquare(const Pose& pose, Pairs pairs) {
    double squares = 0.0;
    for (const PointPair& pair : pairs) {
        const double distance = distanceOf(pose, pair);
        squares += distance * distance;
    }
    return std::sqrt(squares / static_cast<double>(pairs.size()));
}

// Whether the mirror image fits about as well, as that of points in one plane does.
bool isFlat(Pairs pairs) {
    constexpr double kAlike = 2.0, kRounding = 1e-6; // [m]
    const std::vector<PointPair> image = mirrored(pairs);
    return rootMeanSquare(poseOf(image), image) <= kAlike * rootMeanSquare(poseOf(pairs), pairs) + kRounding;
}

std::string rejectionOf(Pairs pairs, const FitLimits& limits, const Consensus& found,
                        const RobustFit& robust) {
    const std::string worst = named(farthest(pairs, robust.fit.baseTcamera, 0.0));
    const auto nearest = std::ranges::min_element(
        pairs, [](const auto& a, const auto& b) { return glm::length(a.camera) < glm::length(b.camera); });
    if (glm::length(nearest->camera) >= kFar) {
        return printed("every point is over %.4g m from the camera (millimetres?)", kFar);
    }
    const double scale = scaleOf(pairs);
    if (!(std::abs(scale - 1.0) <= kMaxScale)) {
        return printed("distances in the base frame are %.6g times those in the camera frame (units?)",
                       scale) +
               worst;
    }
    if (isMirrored(pairs, found)) {
        return "the pairs fit a mirror image: an axis is negated, or two are swapped" + worst;
    }
    if (!(robust.fit.sigma <= limits.residual)) {
        return printed("standard deviation of %.3g mm, over the bound of %.3g mm", 1e3 * robust.fit.sigma,
                       1e3 * limits.residual) +
               worst;
    }
    if (static_cast<double>(robust.outliers.size()) >
        limits.outlierShare * static_cast<double>(pairs.size())) {
        return std::to_string(robust.outliers.size()) + " of " + std::to_string(pairs.size()) +
               " pairs do not fit the others" + named(robust.outliers);
    }
    if (!(robust.fit.turn <= kMaxTurn)) {
        return "the points lie too near to one line, or to each other, for their scatter: the rotation is "
               "uncertain by " +
               printed("%.2g degrees, over %.2g degrees", glm::degrees(std::min(robust.fit.turn, 1.0)),
                       glm::degrees(kMaxTurn));
    }
    return "";
}

} // namespace

RobustFit fitRobust(std::span<const PointPair> pairs, const FitLimits& limits, const std::string& source) {
    RobustFit robust;
    robust.fit = fitRigid(pairs, source);
    const Consensus found = Search(pairs).run();
    // Few pairs fit themselves closely, so their scatter is estimated too low (Rousseeuw and Leroy 1987).
    const double spread = 3.0 * (1.0 + 5.0 / (static_cast<double>(pairs.size()) - 2.0)) * found.distance;
    const double tolerance = std::clamp(spread, kMinTolerance, std::max(kMinTolerance, limits.residual));
    Pose pose = found.distance < HUGE_VAL ? found.pose : robust.fit.baseTcamera;
    for (int round = 0; round < 10; ++round) {
        const std::vector<PointPair> inliers = believed(pairs, pose, tolerance);
        if (inliers.size() < 4 || 2 * inliers.size() < pairs.size()) {
            break; // no agreement: the plain fit, whose residual says so
        }
        robust.fit = fitRigid(inliers, source);
        robust.outliers = farthest(pairs, robust.fit.baseTcamera, tolerance);
        if (robust.outliers.size() + inliers.size() == pairs.size()) {
            break;
        }
        pose = robust.fit.baseTcamera;
    }
    robust.flat =
        isFlat(believed(pairs, robust.fit.baseTcamera, robust.outliers.empty() ? HUGE_VAL : tolerance));
    robust.rejection = rejectionOf(pairs, limits, found, robust);
    return robust;
}

} // namespace fathom
