// SPDX-License-Identifier: Apache-2.0
// The unit of frames whose depth is in metres.
#include "devices/images/metre_units.h"

#include <algorithm>
#include <doctest/doctest.h>
#include <limits>
#include <vector>

using namespace fathom;

namespace {

constexpr double kNoScene = std::numeric_limits<double>::infinity(); // convert and inspect have no far

ValueSpan spanOf(const std::vector<double>& values) {
    ValueSpan span;
    for (const double value : values) {
        ValueSpan one;
        one.add(value);
        span.add(one);
    }
    return span;
}

} // namespace

TEST_CASE("A background that a renderer writes as a far depth does not make the unit of depth coarser") {
    for (const double background : {100.0, 1000.0, 65504.0, 1e10, 1e300}) {
        CAPTURE(background);
        CHECK(unitForMetres(spanOf({0.537, background}), kNoScene) == doctest::Approx(1e-4));
        CHECK(unitForMetres(spanOf({0.537, background}), kNoScene, 1.0) == doctest::Approx(1e-4));
        CHECK(unitForMetres(spanOf({0.537, 20.0, background}), kNoScene) == doctest::Approx(5e-4));
        CHECK(unitForMetres(spanOf({0.537, background}), 10.0) == doctest::Approx(2e-4)); // up to the far
        const ValueSpan millimetres = spanOf({537.0, 1000.0 * background});
        CHECK(unitForMetres(millimetres.scaled(0.001), kNoScene) == doctest::Approx(1e-4));
    }
}

TEST_CASE("Depth that is all far away, or near up to far away, has a unit that holds it") {
    CHECK(unitForMetres(spanOf({100.0, 200.0}), kNoScene) == doctest::Approx(4.7e-3));
    CHECK(unitForMetres(spanOf({64.5, 64.9}), kNoScene) == doctest::Approx(1e-3));
    CHECK(unitForMetres(spanOf({0.5, 5.0, 30.0, 60.0, 90.0}), kNoScene) == doctest::Approx(1e-3));
    CHECK(unitForMetres(spanOf({0.5}), kNoScene) == doctest::Approx(1e-4));
}

TEST_CASE(
    "Values that are too large for metres are taken for the unit that places them in front of a camera") {
    CHECK(metresWarning("a.pcd", spanOf({49.0})).empty());
    for (const auto& [nearest, unit] : {std::pair{50.0, "centimetres, put ,scale=0.01 "},
                                        {500.0, "millimetres, put ,scale=0.001 "},
                                        {5e5, "micrometres, put ,scale=0.000001 "}}) {
        CHECK(metresWarning("a.pcd", spanOf({nearest})).find(unit) != std::string::npos);
    }
    CHECK(metresWarning("a.pcd", spanOf({1e9})) == "a.pcd: the nearest point is at 1e+09 m");
}

TEST_CASE("A few near values, as resizing makes them at holes, do not hide that the others are no metres") {
    const auto warned = [](size_t near, size_t far, double background, size_t others) {
        std::vector<double> values(near, 0.9);
        values.insert(values.end(), others, background);
        for (size_t i = 0; i < far; ++i) {
            values.push_back(600.0 + static_cast<double>(i) / 8.0);
        }
        return metresWarning("a.npy", spanOf(values));
    };
    CHECK(warned(1, 999, 0.0, 0) == "a.npy: 99.9 % of its points are at 600 m or beyond; if its values are "
                                    "millimetres, put ,scale=0.001 after its name");
    CHECK(warned(0, 0, 500.0, 999).find("millimetres") != std::string::npos); // a plane
    CHECK(warned(50, 900, 0.0, 0).find("millimetres") != std::string::npos);
    for (const double background : {60.0, 100.0, 1000.0, 1e10}) { // of a renderer
        CHECK(warned(7, 0, background, 993).empty());
    }
    std::vector<double> rays(20, 0.0); // a background along the rays
    std::ranges::generate(rays, [far = 1e10]() mutable { return far += 1e8; });
    rays.push_back(0.5);
    CHECK(metresWarning("a.npy", spanOf(rays)).empty());
    CHECK(warned(7, 900, 1e10, 93).find("millimetres") != std::string::npos);
    CHECK(warned(200, 800, 0.0, 0).empty()); // a landscape
    CHECK(metresWarning("a.npy", spanOf({})).empty());
}
