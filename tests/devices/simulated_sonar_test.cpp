// SPDX-License-Identifier: Apache-2.0
#include "devices/simulated/simulated_sonar.h"

#include "devices/recorded/recorded_camera.h"
#include "devices/recorded/recording_writer.h"
#include "devices/simulated/sonar_scene.h"
#include "engine/types/error.h"
#include "engine/types/median.h"
#include "tests/devices/recorded_folder.h"

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <glm/geometric.hpp>

using namespace fathom;

namespace {

SimulatedSonarOptions smallSonar() {
    SimulatedSonarOptions options;
    options.width = 80, options.height = 60;
    options.step *= 2.0;
    options.frames = 3;
    options.baseTscene = {{0.1, 0.2, 0.3}, rotationExp({0.1, 0.0, 0.2})};
    return options;
}

// Share of a frame's readings whose true echo lies within three sigma of where the reading puts it.
double shareWithin(SimulatedSonar& sonar, const Frame& frame) {
    size_t readings = 0, within = 0;
    const Intrinsics& lens = sonar.info().depth;
    for (uint32_t i = 0; i < lens.pixels(); ++i) {
        if (frame->depth[i] == 0) {
            continue;
        }
        const uint32_t column = i % lens.width, row = i / lens.width;
        const dvec3 ray(lens.ray(column, row), 1.0);
        const dvec3 point = frame->depth[i] * sonar.info().metresPerUnit * ray;
        const double rounding = 0.5 * sonar.info().metresPerUnit * glm::length(ray);
        const double off = glm::distance(frame->baseTcamera->apply(point), sonar.echo(i).point);
        ++readings;
        within += off <= 3.0 * sonar.info().sigmaAt(point) + rounding ? 1 : 0;
    }
    REQUIRE(readings > 2000);
    return static_cast<double>(within) / static_cast<double>(readings);
}

} // namespace

TEST_CASE("The true echo of a beam is within three sigma of its reading: always without noise, nearly always "
          "with it") {
    SimulatedSonarOptions options = smallSonar();
    SimulatedSonar noisy(sonarScene(), options);
    const double share = shareWithin(noisy, *noisy.next());
    CHECK(share > 0.99);
    options.noise = false;
    SimulatedSonar exact(sonarScene(), options);
    CHECK(shareWithin(exact, *exact.next()) == 1.0);
    MESSAGE("within three sigma: ", 100.0 * share, " % of the noisy readings");
}

TEST_CASE("Steel echoes louder than sand and concrete, in a frame of greys") {
    SimulatedSonar sonar(sonarScene(), smallSonar());
    const auto frame = sonar.next();
    REQUIRE(frame);
    std::vector<std::vector<uint32_t>> levels(3);
    for (uint32_t i = 0; i < sonar.info().depth.pixels(); ++i) {
        const uint32_t c = (*frame)->colour[i];
        CHECK((c & 255) == (c >> 8 & 255));
        CHECK((c & 255) == (c >> 16 & 255));
        if ((*frame)->depth[i] != 0) {
            levels[static_cast<size_t>(sonar.echo(i).object)].push_back(c & 255);
        }
    }
    const auto median = [](std::vector<uint32_t>& v) {
        REQUIRE(v.size() > 20);
        return medianOf(v);
    };
    CHECK(median(levels[1]) > 120); // steel
    CHECK(median(levels[0]) < 40);  // sand
    CHECK(median(levels[2]) < 100); // concrete
    CHECK(median(levels[2]) > 40);
}

TEST_CASE("A sonar's frames are numbered, ten per second, finite in number, and depend only on the options") {
    SimulatedSonar one(sonarScene(), smallSonar()), other(sonarScene(), smallSonar());
    std::vector<uint16_t> before;
    for (uint32_t k = 0; k < 3; ++k) {
        const auto a = one.next(), b = other.next();
        REQUIRE(a);
        REQUIRE(b);
        CHECK((*a)->index == k);
        CHECK((*a)->captureTime == doctest::Approx(0.1 * k));
        CHECK(std::equal((*a)->depth.begin(), (*a)->depth.end(), (*b)->depth.begin()));
        CHECK_FALSE(std::equal((*a)->depth.begin(), (*a)->depth.end(), before.begin(), before.end()));
        before.assign((*a)->depth.begin(), (*a)->depth.end());
    }
    CHECK_FALSE(one.next());
    SimulatedSonarOptions wide = smallSonar();
    wide.step = 0.1;
    CHECK_THROWS_AS(SimulatedSonar(sonarScene(), wide), Error);
    wide.width = 0;
    CHECK_THROWS_AS(SimulatedSonar(sonarScene(), wide), Error);
}

TEST_CASE("A recorded sonar is read back with its fan, its beam and every frame; ranges become depths") {
    const TemporaryFolder folder;
    SimulatedSonar sonar(sonarScene(), smallSonar());
    std::vector<std::vector<uint16_t>> seen;
    {
        RecordingWriter writer(folder.path() / "rec", sonar.info(), 1);
        while (const auto frame = sonar.next()) {
            seen.emplace_back((*frame)->depth.begin(), (*frame)->depth.end());
            writer.add(*frame);
        }
        writer.finish();
    }
    RecordedCamera recorded(folder.path() / "rec");
    const CameraInfo& info = recorded.info();
    CHECK(info.depth.fan);
    CHECK(info.depth.fx == doctest::Approx(sonar.info().depth.fx));
    REQUIRE(info.beam);
    CHECK(info.beam->width == doctest::Approx(sonar.info().beam->width));
    CHECK(info.beam->range == doctest::Approx(0.004));
    for (const auto& depth : seen) {
        const auto frame = recorded.next();
        REQUIRE(frame);
        CHECK(std::equal(depth.begin(), depth.end(), (*frame)->depth.begin(), (*frame)->depth.end()));
    }
    // The same frames, said to hold ranges.
    std::ifstream in(folder.path() / "rec/intrinsics.json");
    std::string text{std::istreambuf_iterator<char>(in), {}};
    text.insert(text.find('{') + 1, "\"depth_is\": \"range\",");
    folder.write("rec/intrinsics.json", text);
    RecordedCamera ranges(folder.path() / "rec");
    const auto frame = ranges.next();
    REQUIRE(frame);
    for (uint32_t i = 0; i < info.depth.pixels(); ++i) {
        const uint32_t column = i % info.depth.width, row = i / info.depth.width;
        const dvec3 ray(info.depth.ray(column, row), 1.0);
        CHECK(std::abs((*frame)->depth[i] - seen[0][i] / glm::length(ray)) <= 0.51);
    }
    folder.write("rec/intrinsics.json", text.replace(text.find("range\""), 5, "rings"));
    CHECK_THROWS_WITH_AS(RecordedCamera(folder.path() / "rec"), doctest::Contains("depth_is"), BadInput);
}
