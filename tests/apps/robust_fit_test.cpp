// SPDX-License-Identifier: Apache-2.0
// Registrations that must not be believed: scale, mirror images, outliers, scatter.
#include "apps/register/robust_fit.h"
#include "tests/apps/point_pairs.h"
#include "tests/support/mentions.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>
#include <random>
#include <string>
#include <utility>
#include <vector>

using namespace fathom;
using namespace fathom::testing;

namespace {

const FitLimits kByHand{};

double offBy(const RobustFit& robust) {
    return glm::distance(robust.fit.baseTcamera.apply({0, 0, 1}), kBaseTcamera.apply({0, 0, 1}));
}

// Random points within `extent` on either side of (0, 0, 1), along a tilted direction for a line.
std::vector<PointPair> scattered(size_t count, const dvec3& extent, double cameraNoise, double baseNoise) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> place(-1.0, 1.0);
    std::normal_distribution<double> error(0.0, 1.0);
    const auto noise = [&](double sigma) {
        const double x = error(random), y = error(random), z = error(random);
        return sigma * dvec3(x, y, z);
    };
    const dquat tilt = glm::normalize(dquat(1.0, 0.3, -0.2, 0.1));
    std::vector<PointPair> pairs;
    for (size_t i = 0; i < count; ++i) {
        const double x = place(random), y = place(random), z = place(random);
        const dvec3 p = tilt * (extent * dvec3(x, y, z)) + dvec3(0.0, 0.0, 1.0);
        const dvec3 seen = p + noise(cameraNoise);
        pairs.push_back({seen, kBaseTcamera.apply(p) + noise(baseNoise), "line " + std::to_string(i + 2)});
    }
    return pairs;
}

} // namespace

TEST_CASE("Good pairs are accepted and give the least-squares fit, exact or noisy, few or many") {
    for (const size_t count : {4, 5, 8, 40, 900}) {
        for (const double noise : {0.0, 0.001, 0.003}) {
            CAPTURE(count);
            CAPTURE(noise);
            const auto pairs = pairsOf(count, noise);
            const RobustFit robust = fitRobust(pairs, kByHand, "test");
            CHECK(robust.rejection == "");
            CHECK(robust.outliers.empty());
            CHECK(offBy(robust) <= 4.0 * noise + 1e-9);
            CHECK(robust.fit.sigma == fitRigid(pairs, "test").sigma);
        }
    }
}

TEST_CASE("Distances in other units are rejected with their ratio and the worst pairs") {
    for (const double scale : {1000.0, 0.01, 25.4, 1.1, 0.9}) {
        CAPTURE(scale);
        auto pairs = pairsOf(6, 0.001);
        for (PointPair& pair : pairs) {
            pair.base *= scale;
        }
        const RobustFit robust = fitRobust(pairs, kByHand, "test");
        mentions(robust.rejection, "times those in the camera frame (units?)");
        mentions(robust.rejection, "; worst line ");
    }
}

TEST_CASE("Points that are all far from the camera are rejected: both columns may be millimetres") {
    auto pairs = pairsOf(6, 0.001);
    for (PointPair& pair : pairs) {
        pair.base *= 1000.0;
        pair.camera *= 1000.0;
    }
    mentions(fitRobust(pairs, {.residual = 1e3}, "test").rejection, "m from the camera (millimetres?)");
    pairs[2].camera = {0.0, 0.0, 1.0}; // in metres
    pairs[2].base = kBaseTcamera.position;
    CHECK(fitRobust(pairs, {.residual = 1e3}, "test").rejection.find("millimetres") == std::string::npos);
}

TEST_CASE("A mirror image is rejected, whichever axis is negated or swapped") {
    for (int axis = 0; axis < 4; ++axis) {
        CAPTURE(axis);
        auto pairs = pairsOf(7, 0.001);
        for (PointPair& pair : pairs) {
            if (axis == 3) {
                std::swap(pair.base.x, pair.base.y);
            } else {
                pair.base[axis] = -pair.base[axis];
            }
        }
        mentions(fitRobust(pairs, kByHand, "test").rejection, "mirror image");
    }
}

TEST_CASE("Outliers are left out of the fit, listed farthest first, and rejected") {
    for (const size_t count : {6, 10, 60}) {
        CAPTURE(count);
        auto pairs = pairsOf(count, 0.0005);
        pairs[2].base += dvec3(0.3, 0.0, 0.0);
        const size_t outliers = count >= 10 ? 2 : 1;
        if (outliers == 2) {
            std::swap(pairs[7].base, pairs[8].base); // typed in the wrong order: two more
            pairs[7].base = kBaseTcamera.apply(pairs[7].camera);
            pairs[8].base = kBaseTcamera.apply(pairs[8].camera) + dvec3(0.0, 0.1, 0.0);
        }
        const RobustFit robust = fitRobust(pairs, kByHand, "test");
        REQUIRE(robust.outliers.size() == outliers);
        CHECK(robust.outliers[0].name == "line 4");
        CHECK(robust.outliers[0].distance == doctest::Approx(0.3).epsilon(0.02));
        CHECK(offBy(robust) < 0.003);
        mentions(robust.rejection, std::to_string(outliers) + " of " + std::to_string(count) +
                                       " pairs do not fit the others; worst line 4 30");
        FitLimits lenient;
        lenient.outlierShare = 0.4;
        CHECK(fitRobust(pairs, lenient, "test").rejection == "");
    }
}

TEST_CASE(
    "Pairs that scatter beyond the bound are rejected with their standard deviation and the worst pairs") {
    const auto pairs = pairsOf(20, 0.03);
    const RobustFit robust = fitRobust(pairs, kByHand, "test");
    CHECK(robust.rejection != "");
    mentions(robust.rejection, "; worst line ");
    FitLimits wide;
    wide.residual = 0.3;
    CHECK(fitRobust(pairs, wide, "test").rejection == "");
}

TEST_CASE(
    "Points on one line are rejected whatever their scatter, and points too near to each other for it") {
    const dvec3 line(0.25, 0.0, 0.0);
    for (const size_t count : {4, 8, 30, 300}) {
        for (const auto& given : {std::pair(0.0, 0.002), std::pair(0.001, 0.002), std::pair(0.003, 0.003)}) {
            const auto &cameraNoise = given.first, &baseNoise = given.second;
            CAPTURE(count);
            CAPTURE(cameraNoise);
            CAPTURE(baseNoise);
            const RobustFit robust =
                fitRobust(scattered(count, line, cameraNoise, baseNoise), kByHand, "test");
            CHECK(robust.rejection != ""); // large scatter also looks like other units
            CHECK(robust.fit.turn > 0.1);
        }
    }
    mentions(fitRobust(scattered(30, line, 0.001, 0.002), kByHand, "test").rejection,
             "too near to one line, or to each other, for their scatter: the rotation is uncertain by ");
    const RobustFit near = fitRobust(scattered(8, {0.006, 0.006, 0.006}, 0.0, 0.002), kByHand, "test");
    CHECK(near.rejection != "");
    CHECK(near.fit.turn > 0.05);
    for (const dvec3& extent : {dvec3(0.25, 0.1, 0.0), dvec3(0.1, 0.1, 0.1), dvec3(0.25, 0.05, 0.05)}) {
        const RobustFit robust = fitRobust(scattered(8, extent, 0.0, 0.002), kByHand, "test");
        CHECK(robust.rejection == "");
        CHECK(offBy(robust) < 0.03);
    }
}

TEST_CASE("Points in one plane are called flat, because a mirror image fits them, and others are not") {
    for (const double noise : {0.0, 0.003}) {
        for (const double sign : {1.0, -1.0}) {
            CAPTURE(noise);
            CAPTURE(sign);
            auto flat = scattered(8, {0.3, 0.3, 0.0}, 0.0, noise),
                 deep = scattered(8, {0.3, 0.3, 0.1}, 0.0, noise);
            for (auto* pairs : {&flat, &deep}) {
                for (PointPair& pair : *pairs) {
                    pair.camera.y *= sign;
                }
            }
            const RobustFit robust = fitRobust(flat, kByHand, "test");
            CHECK(robust.flat);
            CHECK(robust.rejection == "");
            if (sign > 0.0) {
                CHECK_FALSE(fitRobust(deep, kByHand, "test").flat);
            } else {
                mentions(fitRobust(deep, kByHand, "test").rejection, "mirror image");
            }
        }
    }
}

TEST_CASE("A corner that is far off in several frames is named once among the worst") {
    auto pairs = pairsOf(20, 0.03);
    for (size_t i = 0; i < 5; ++i) {
        pairs.push_back(pairs[i]);
        pairs.push_back(pairs[i]);
    }
    for (const PointPair& pair : pairs) {
        const std::string rejection = fitRobust(pairs, kByHand, "test").rejection;
        const size_t first = rejection.find(pair.name + " ");
        CHECK(
            (first == std::string::npos || rejection.find(pair.name + " ", first + 1) == std::string::npos));
    }
}
