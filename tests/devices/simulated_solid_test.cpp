// SPDX-License-Identifier: Apache-2.0
#include "devices/simulated/solid.h"

#include <cmath>
#include <doctest/doctest.h>
#include <glm/geometric.hpp>
#include <random>
#include <string>
#include <vector>

using namespace fathom;

namespace {

struct Named {
    std::string name;
    Solid solid;
};

std::vector<Named> everyKind() {
    const Paint paint;
    const dvec3 centre(0.05, -0.03, 0.9);
    const Pose posed{centre, rotationExp({0.4, -0.7, 0.3})};
    return {{"sphere", sphereAt(centre, 0.08, paint)},
            {"box", boxAt(posed, {0.1, 0.05, 0.02}, paint)},
            {"axis-aligned box", boxAt({centre, dquat(1, 0, 0, 0)}, {0.1, 0.05, 0.02}, paint)},
            {"plane", planeThrough(centre, {0.2, 0.3, -1.0}, paint)},
            {"capsule", capsuleBetween(centre, centre + dvec3(0.1, 0.12, -0.05), 0.02, paint)},
            {"cylinder", cylinderBetween(centre, centre + dvec3(0.1, 0.12, -0.05), 0.03, paint)},
            {"disc", cylinderBetween(centre, centre + dvec3(0.0, 0.0, -0.004), 0.09, paint)},
            {"torus", torusAt(centre, {0.3, 0.5, -1.0}, 0.07, 0.01, paint)},
            {"fat torus", torusAt(centre, {1.0, 0.1, 0.1}, 0.05, 0.045, paint)}};
}

// Rays from round the origin towards a neighbourhood of the solid: hits, misses and grazing ones.
Ray randomRay(std::mt19937& random) {
    std::uniform_real_distribution<double> small(-0.3, 0.3), aim(-0.16, 0.16);
    const dvec3 origin(small(random), small(random), small(random));
    const dvec3 target = dvec3(0.08, 0.0, 0.88) + dvec3(aim(random), aim(random), aim(random));
    return {origin, glm::normalize(target - origin)};
}

// Where the sampled distance first drops to zero, or a negative number.
double firstInside(const Solid& solid, const Ray& ray, double until) {
    for (double t = 0.0; t < until;) {
        const double distance = signedDistance(solid, ray.origin + t * ray.direction);
        if (distance < -1e-9) {
            return t;
        }
        t += std::fmax(distance, 2e-5);
    }
    return -1.0;
}

} // namespace

TEST_CASE("A ray enters every kind of solid on its surface, facing it, and not behind a nearer part of it") {
    for (const Named& named : everyKind()) {
        CAPTURE(named.name);
        std::mt19937 random(11);
        int hits = 0;
        double worst = 0.0, wrongSide = 0.0;
        for (int i = 0; i < 4000; ++i) {
            const Ray ray = randomRay(random);
            const std::optional<double> t = enter(named.solid, ray);
            if (!t) {
                continue;
            }
            ++hits;
            const dvec3 point = ray.origin + *t * ray.direction;
            worst = std::fmax(worst, std::abs(signedDistance(named.solid, point)));
            wrongSide = std::fmax(wrongSide, glm::dot(surfaceNormal(named.solid, point), ray.direction));
            if (i % 10 == 0) {
                CHECK(firstInside(named.solid, ray, *t - 1e-4) < 0.0);
            }
        }
        CHECK(hits > 300);
        CHECK(worst < 1e-9);
        CHECK(wrongSide < 1e-4);
    }
}

TEST_CASE("A ray that misses a solid never comes inside it") {
    for (const Named& named : everyKind()) {
        CAPTURE(named.name);
        std::mt19937 random(12);
        int misses = 0;
        for (int i = 0; i < 1500; ++i) {
            const Ray ray = randomRay(random);
            if (!enter(named.solid, ray)) {
                ++misses;
                CHECK(firstInside(named.solid, ray, 2.0) < 0.0);
            }
        }
        CHECK((misses > 100 || named.solid.kind == SolidKind::Plane));
    }
}

TEST_CASE("The signed distance has unit slope along the surface normal, on both sides") {
    for (const Named& named : everyKind()) {
        CAPTURE(named.name);
        std::mt19937 random(13);
        double worst = 0.0;
        for (int i = 0; i < 1000; ++i) {
            const Ray ray = randomRay(random);
            if (const std::optional<double> t = enter(named.solid, ray)) {
                const dvec3 point = ray.origin + *t * ray.direction;
                const dvec3 out = surfaceNormal(named.solid, point);
                for (const double step : {-1e-5, 1e-5, 1e-3}) {
                    // Outwards the distance grows by the step anywhere; inwards an edge may be nearer than
                    // the face.
                    const double distance = signedDistance(named.solid, point + step * out);
                    worst = std::fmax(worst, step > 0.0 ? std::abs(distance - step)
                                                        : std::fmax(distance, step - distance));
                }
            }
        }
        CHECK(worst < (named.name == "fat torus" ? 1e-8 : 1e-9)); // its hole is 5 mm wide, the steps 1 mm
    }
}

TEST_CASE("The hull's spheres and the enclosing ball contain every point of the surface") {
    for (const Named& named : everyKind()) {
        CAPTURE(named.name);
        const HullSpheres hull = hullOf(named.solid);
        if (named.solid.kind == SolidKind::Plane) {
            CHECK(hull.count == 0);
            continue;
        }
        std::mt19937 random(14);
        for (int i = 0; i < 1000; ++i) {
            const Ray ray = randomRay(random);
            const std::optional<double> t = enter(named.solid, ray);
            if (!t) {
                continue;
            }
            const dvec3 point = ray.origin + *t * ray.direction;
            CHECK(glm::length(point - named.solid.position) <= named.solid.bound + 1e-10);
            // A convex hull contains a point when no direction separates it: test many.
            for (int k = 0; k < 20; ++k) {
                const dvec3 along = randomRay(random).direction * (k % 2 ? 1.0 : -1.0);
                double reach = -HUGE_VAL;
                for (uint32_t h = 0; h < hull.count; ++h) {
                    reach =
                        std::fmax(reach, glm::dot(hull.spheres[h].centre, along) + hull.spheres[h].radius);
                }
                CHECK(glm::dot(point, along) <= reach + 1e-10);
            }
        }
    }
}

TEST_CASE("A ray that starts inside a solid does not enter it") {
    for (const Named& named : everyKind()) {
        CAPTURE(named.name);
        std::mt19937 random(15);
        for (int i = 0; i < 300; ++i) {
            Ray ray = randomRay(random);
            if (const std::optional<double> t = enter(named.solid, ray)) {
                ray.origin += (*t + 1e-6) * ray.direction;
                if (signedDistance(named.solid, ray.origin) < -1e-9 && named.solid.kind != SolidKind::Torus) {
                    CHECK_FALSE(enter(named.solid, ray).has_value());
                }
            }
        }
    }
}
