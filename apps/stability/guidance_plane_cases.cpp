// SPDX-License-Identifier: Apache-2.0
// Group guidance on point sets: non-planar sets, exact planes, noise against theory, eigenvectors.
#include "apps/stability/case_text.h"
#include "apps/stability/guidance_parts.h"
#include "engine/cloud/guidance_pose.h"
#include "engine/reference/rng.h"
#include "engine/types/angle.h"

#include <algorithm>
#include <cmath>

namespace fathom::stability {

namespace {

const dvec3 kCamera(0.0);

FixtureClass guided() {
    FixtureClass fixture;
    fixture.role = Role::Guidance;
    fixture.minCount = 1;
    return fixture;
}

GuidancePose poseOf(const std::vector<dvec3>& points) {
    return cloud::guidancePose(cloud::momentsOf(points), guided(), 0, kCamera);
}

bool isSound(const GuidancePose& pose) {
    return isFinite(pose.target) && isFinite(pose.position) && isFinite(pose.normal) &&
           std::abs(glm::length(pose.target.rotation) - 1.0) < 1e-12 &&
           (!pose.planar || std::abs(glm::length(pose.normal) - 1.0) < 1e-12);
}

// Disc of points around `centre`, perpendicular to `normal`, with noise along z (the optical axis of a
// camera).
std::vector<dvec3> disc(Rng& rng, const dvec3& centre, const dvec3& normal, double radius, int count,
                        double sigma) {
    const dvec3 u =
        glm::normalize(glm::cross(normal, std::abs(normal.x) < 0.9 ? dvec3(1, 0, 0) : dvec3(0, 1, 0)));
    const dvec3 v = glm::cross(normal, u);
    std::vector<dvec3> points;
    for (int i = 0; i < count; ++i) {
        const double r = radius * std::sqrt(rng.uniform(0.0, 1.0)), a = rng.uniform(0.0, kTurn);
        points.push_back(centre + r * std::cos(a) * u + r * std::sin(a) * v + sigma * rng.normal() * normal);
    }
    return points;
}

double angleOf(const dvec3& a, const dvec3& b) {
    return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

// Points on a line have no normal; rounding alone would choose one.
Outcome collinear(RunLength runLength) {
    int wrong = 0, tried = 0;
    Rng rng(4);
    for (int n = 0; n < (runLength == RunLength::Full ? 3000 : 400); ++n) {
        const dvec3 along = rng.direction(), centre = rng.logUniform(0.1, 100.0) * rng.direction();
        const double length = rng.logUniform(1e-4, 10.0);
        std::vector<dvec3> points;
        for (size_t i = 0, count = 2 + rng.below(400); i < count; ++i) {
            points.push_back(centre + rng.uniform(-length, length) * along);
        }
        const GuidancePose pose = poseOf(points);
        ++tried;
        wrong += pose.planar || !isSound(pose) || pose.target.rotation != guided().orientation ? 1 : 0;
    }
    return outcomeOf(wrong, 0.0, "1",
                     "Points on a line of 0.1 mm to 10 m, 2 to 401 of them, up to 100 m away: how many of " +
                         std::to_string(tried) +
                         " were taken for a plane, were not finite or lost the scene's own orientation.");
}

// No point, one, two, and many points at one position.
Outcome fewPoints(RunLength) {
    int wrong = 0;
    Rng rng(6);
    for (const size_t count : {size_t{0}, size_t{1}, size_t{2}, size_t{3}, size_t{1000}}) {
        for (int n = 0; n < 50; ++n) {
            const dvec3 place = n == 0 ? kCamera : rng.logUniform(0.1, 1e5) * rng.direction();
            const GuidancePose pose = poseOf(std::vector<dvec3>(count, place));
            const double off = count == 0 ? 0.0 : glm::distance(pose.position, place);
            wrong += pose.planar || !isSound(pose) || pose.present != (count > 0) ||
                             off > 1e-12 * (1.0 + glm::length(place))
                         ? 1
                         : 0;
        }
    }
    return outcomeOf(wrong, 0.0, "1",
                     "None, one, two, three and a thousand points at one place, also at the camera itself: "
                     "results that are a plane, not finite, or not at that place; 250 sets.");
}

Outcome exactPlane(RunLength runLength) {
    double worst = 0.0;
    int lost = 0;
    Rng rng(7);
    const int planes = runLength == RunLength::Full ? 3000 : 300;
    for (int n = 0; n < planes; ++n) {
        const dvec3 centre = rng.logUniform(0.1, 1e5) * rng.direction(), normal = rng.direction();
        const GuidancePose pose = poseOf(disc(rng, centre, normal, rng.logUniform(0.02, 2.0), 300, 0.0));
        lost += !pose.planar || !isSound(pose) ? 1 : 0;
        worst = std::max(worst,
                         angleOf(pose.normal, glm::dot(normal, kCamera - centre) < 0.0 ? -normal : normal));
    }
    Outcome out = outcomeOf(worst, 1e-7, "rad",
                            "Exact planes of 20 mm to 2 m, 0.1 m to 100 km from the base origin, seen from "
                            "every side: largest error of the normal over " +
                                std::to_string(planes) + "; at 100 km a coordinate is rounded to 1.5e-11 m.");
    require(out, lost == 0, std::to_string(lost) + " were not taken for a plane");
    return out;
}

// Theory: the normal's error is sigma / (s_rms sqrt(N)) about each of its two axes.
Outcome noisyPlane(RunLength runLength) {
    double worst = 0.0;
    Rng rng(9);
    const int trials = runLength == RunLength::Full ? 3000 : 700;
    Outcome::Curve measured{"measured", "sigma [m]", "normal error per axis [rad]", {}, {}, true, true},
        theory = measured;
    theory.name = "sigma / (s_rms sqrt(N))";
    for (const double sigma : {0.0001, 0.0005, 0.001, 0.002, 0.005, 0.01}) {
        const double radius =
            std::max(0.04, (sigma > 0.003 ? 30.0 : 20.0) *
                               sigma); // a set thicker than 3 mm and a tenth of its spread is no plane
        const int count = sigma == 0.002 ? 1000 : 400;
        double sum = 0.0;
        int planar = 0;
        for (int n = 0; n < trials; ++n) {
            const dvec3 normal = glm::normalize(dvec3(0.3, -0.2, -1.0));
            const GuidancePose pose = poseOf(disc(rng, {0.0, 0.0, 1.0}, normal, radius, count, sigma));
            const double angle = pose.planar ? angleOf(pose.normal, normal) : 0.0;
            sum += angle * angle;
            planar += pose.planar ? 1 : 0;
        }
        const double axis = std::sqrt(0.5 * sum / std::max(1, planar)),
                     expected = sigma / (0.5 * radius * std::sqrt(count));
        worst = planar == trials ? std::max(worst, std::abs(axis / expected - 1.0)) : 1e9;
        measured.x.push_back(sigma);
        measured.y.push_back(axis);
        theory.x.push_back(sigma);
        theory.y.push_back(expected);
    }
    // The mean square of 2 x trials normal samples has a standard deviation of 1/sqrt(trials); its root has
    // half of that.
    Outcome out = outcomeOf(worst, 0.02 + 4.0 * 0.5 / std::sqrt(trials), "1",
                            "Noise of 0.1 to 10 mm on a disc of at least 40 mm, 400 or 1000 points: error of "
                            "the normal on each axis against sigma / "
                            "(s_rms sqrt(N)), relative, worst of six; 2 mm, 40 mm, 1000 points: " +
                                num(measured.y[3] * 1e3) + " mrad (3.2 by theory). Limit: 4 sigma of " +
                                std::to_string(trials) + " trials and 2 % for the formula.");
    out.curves = {measured, theory};
    return out;
}

// A thick cloud is not a plane, and a disc has no long axis.
Outcome decisions(RunLength runLength) {
    int wrong = 0, tried = 0;
    Rng rng(11);
    for (int n = 0; n < (runLength == RunLength::Full ? 2000 : 300); ++n) {
        const dvec3 normal = rng.direction(), centre = rng.logUniform(0.3, 30.0) * rng.direction();
        const double radius = rng.logUniform(0.03, 0.3), spread = 0.5 * radius; // s_rms per axis
        const double thin = 0.8 * std::max(0.003, 0.1 * spread), thick = 1.25 * std::max(0.003, 0.1 * spread);
        const GuidancePose plane = poseOf(disc(rng, centre, normal, radius, 2000, thin));
        const GuidancePose cloud = poseOf(disc(rng, centre, normal, radius, 2000, thick));
        tried += 2;
        wrong += plane.planar && plane.rollFree ? 0 : 1;
        wrong += !cloud.planar && cloud.target.rotation == guided().orientation ? 0 : 1;
    }
    return outcomeOf(wrong, 0.0, "1",
                     "Discs 20 % thinner and 25 % thicker than the limit for a plane (3 mm or a tenth of the "
                     "spread): wrong decisions, or a roll commanded without a long axis, of " +
                         std::to_string(tried) + ".");
}

// Closed-form solutions fail at nearly equal eigenvalues.
Outcome eigenvectors(RunLength runLength) {
    double worst = 0.0;
    Rng rng(12);
    for (int n = 0; n < (runLength == RunLength::Full ? 200000 : 20000); ++n) {
        const double scale = rng.logUniform(1e-12, 1e6), close = rng.logUniform(1e-17, 1.0);
        const dvec3 values =
            scale * dvec3(1.0, 1.0 - close, n % 3 == 0 ? 1.0 + close : rng.uniform(0.0, 1.0));
        const glm::dmat3 r = glm::mat3_cast(rng.rotation());
        std::array<double, 6> m{};
        const std::array<std::pair<int, int>, 6> at{{{0, 0}, {0, 1}, {0, 2}, {1, 1}, {1, 2}, {2, 2}}};
        for (size_t i = 0; i < 6; ++i) {
            for (int k = 0; k < 3; ++k) {
                m[i] += r[k][at[i].first] * values[k] * r[k][at[i].second];
            }
        }
        const cloud::Eigen3 e = cloud::symmetricEigen(m);
        for (size_t i = 0; i < 6; ++i) {
            double back = 0.0, unit = 0.0;
            for (size_t k = 0; k < 3; ++k) {
                back +=
                    e.vectors[k][at[i].first] * e.values[static_cast<int>(k)] * e.vectors[k][at[i].second];
                unit += e.vectors[k][at[i].first] * e.vectors[k][at[i].second];
            }
            worst = std::max({worst, std::abs(back - m[i]) / (2.0 * scale),
                              std::abs(unit - (at[i].first == at[i].second ? 1.0 : 0.0))});
        }
    }
    return outcomeOf(worst, 1e-14, "1",
                     "Covariances whose eigenvalues differ by 1e-17 to 1 of their size, 1e-12 to 1e6 m^2: "
                     "largest relative error of V L V^T against the matrix, and of V V^T against 1.");
}

} // namespace

std::vector<Case> guidancePlaneCases() {
    return {{"guidance-collinear-points", Group::Guidance, collinear},
            {"guidance-few-points", Group::Guidance, fewPoints},
            {"guidance-exact-plane", Group::Guidance, exactPlane},
            {"guidance-noisy-plane-against-theory", Group::Guidance, noisyPlane},
            {"guidance-plane-or-not", Group::Guidance, decisions},
            {"guidance-near-equal-eigenvalues", Group::Guidance, eigenvectors}};
}

} // namespace fathom::stability
