// SPDX-License-Identifier: Apache-2.0
// The filter moves no point out of its region, whatever its radius and sigma.
#include "tests/cloud/surface_agreement.h"
#include "tests/support/sanitized.h"

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::testing;

namespace {

double noise(int u, int v) {
    return std::sin(u * 12.9898 + v * 78.233) * std::cos(u * 3.1 - v * 7.7);
}

struct Surface {
    const char* name;
    double (*depth)(int u, int v); // [m]
};

constexpr Surface kSurfaces[] = {
    {"step", [](int u, int) { return u < 34 ? 0.7 : 0.78; }},
    {"rim", [](int u, int v) { return std::hypot(u - 33.0, v - 20.0) < 12.0 ? 0.7 : 0.76; }},
    {"rod", [](int u, int) { return u == 30 || u == 31 ? 0.7 : 0.74; }},
    {"ball",
     [](int u, int v) {
         return 0.9 - 0.004 * std::sqrt(std::max(0.0, 900.0 - (u - 33) * (u - 33) - (v - 20) * (v - 20)));
     }},
    {"noise", [](int u, int v) { return 0.7 + 0.02 * noise(u, v); }},
    {"slope", [](int u, int) { return 0.6 + 0.006 * u; }},
};

// [m] largest distance of a filtered point from the point that was measured.
double moved(const CloudRig& rig) {
    const reference::PointImage points = rig.points();
    const reference::FrameView view = rig.view();
    double most = 0.0;
    for (int v = 0; v < rig.height(); ++v) {
        for (int u = 0; u < rig.width(); ++u) {
            const size_t i = view.index(u, v);
            if (points.z[i] != 0.0) {
                const dvec3 measured = view.baseTcamera().apply(view.point(u, v, view.z(u, v)));
                most = std::max(most, glm::distance(points.at[i], measured));
            }
        }
    }
    return most;
}

} // namespace

TEST_CASE("The filter moves no point by more than two fifths of its region's radius, over every radius and "
          "sigma, at edges, rims and in noise, and its twin agrees") {
    const CameraInfo camera = pinholeCamera(67, 41, 0.0001);
    uint32_t bitten = 0;
    double worst = 0.0;
    for (const uint32_t radius : {1u, 2u, 5u, 16u}) {
        for (const double sigma : {1e-4, 1e-2, 0.1, 1.0}) {
            for (const Surface& surface : kSurfaces) {
                if (kSanitized && radius == 16) {
                    continue;
                }
                CAPTURE(radius);
                CAPTURE(sigma);
                CAPTURE(surface.name);
                Scene scene = plainScene();
                scene.fixtures[0].radius = 0.02;
                scene.filter.radius = radius;
                scene.filter.sigma = sigma;
                CloudRig rig(scene, camera);
                rig.run(drawnImage(camera, [&](int u, int v) { return surface.depth(u, v); }));
                const double most = moved(rig);
                CHECK(most <= 0.4 * 0.02 + 1e-6);
                bitten += most > 0.4 * 0.02 - 1e-6;
                worst = std::max(worst, most);
                const SurfaceAgreement agreement = comparePoints(rig);
                CHECK(agreement.points > 100);
                CHECK(agreement.wrong == 0);
                CHECK(agreement.worst < 1e-6);
            }
        }
    }
    CHECK(bitten > (kSanitized ? 3u : 10u)); // the bound matters in these scenes
    MESSAGE("largest displacement ", worst * 1e3, " mm, the bound bites in ", bitten, " scenes");
}

TEST_CASE(
    "The filter's bound follows the smallest forbidden class, its registration sigma, and no spare class") {
    Scene scene = plainScene();
    scene.fixtures[0].radius = 0.08;
    CHECK(scene.filterBound() == doctest::Approx(0.032));
    scene.registrationSigma = 0.01;
    CHECK(scene.filterBound() == doctest::Approx(0.4 * 0.11));
    scene.fixtures.push_back(guidanceClass("target"));
    scene.fixtures.back().radius = 0.001;
    scene.fixtures.push_back(forbiddenClass("", 0.001));
    CHECK(scene.filterBound() == doctest::Approx(0.4 * 0.11));
    scene.fixtures.push_back(forbiddenClass("thin", 0.01));
    CHECK(scene.filterBound() == doctest::Approx(0.4 * 0.04));
}
