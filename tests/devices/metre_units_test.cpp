// SPDX-License-Identifier: Apache-2.0
// The unit of frames whose depth is in metres.
#include "devices/images/metre_units.h"

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
