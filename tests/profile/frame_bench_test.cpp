// SPDX-License-Identifier: Apache-2.0
// The verification before timing: finds a wrong frame wherever in the image the error is.
#include "apps/profile/frame_sequence.h"
#include "apps/profile/half_number.h"
#include "tests/support/vulkan.h"

#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::profile;

namespace {

struct Rig {
    gpu::Instance instance{testing::Vulkan::validation()};
    gpu::Device device{instance, "llvmpipe"};
    FrameSequence source = wallFrame(203, 117, 1.0);
    FrameBench bench{device, studyScene({}), source.camera};
    Rig() { bench.run(source.frames.front()); }
};

} // namespace

TEST_CASE("A frame equals its twins over all and over few patches, and a wrong depth anywhere is found") {
    const Rig rig;
    const SampleFrame& image = rig.source.frames.front();
    CHECK(rig.bench.differsFromTwins(image).empty());
    CHECK(rig.bench.differsFromTwins(image, 7).empty());
    CHECK(rig.bench.differsFromTwins(image, 1).empty());
    for (const size_t pixel : {size_t{0}, size_t{202}, size_t{116 * 203}, size_t{117 * 203 - 1}}) {
        SampleFrame wrong = image; // the corners are always compared
        wrong.depth[pixel] = static_cast<uint16_t>(wrong.depth[pixel] + 40);
        CAPTURE(pixel);
        CHECK(rig.bench.differsFromTwins(wrong, 1).starts_with("point of pixel "));
    }
    size_t found = 0;
    for (uint32_t p = 0; p < 13 * 8; ++p) { // one pixel per patch; 5 patches requested, plus 4 corners
        SampleFrame wrong = image;
        const size_t u = std::min(p % 13 * 16 + 8, 200u), v = std::min(p / 13 * 16 + 2, 115u);
        wrong.depth[v * 203 + u] = static_cast<uint16_t>(wrong.depth[v * 203 + u] + 40);
        found += rig.bench.differsFromTwins(wrong, 5).empty() ? 0 : 1;
    }
    CHECK(found >= 5);
    CHECK(found <= 30); // filter windows cross patch borders
    SampleFrame grey = image;
    grey.colour[60 * 203 + 100] = 0xff808080u; // class bits are compared everywhere
    CHECK(rig.bench.differsFromTwins(grey, 1) == "class bits of pixel " + std::to_string(60 * 203 + 100));
}

TEST_CASE("Every region sphere of a frame is at its own forbidden point, and a moved one is found") {
    Rig rig;
    CHECK(rig.bench.set().host.spheres.size() > 1000);
    CHECK(rig.bench.spheresDiffer().empty());
    auto& spheres = const_cast<RegionSpheres&>(rig.bench.set().host.spheres);
    spheres.x[17] += 1e-4f;
    CHECK(rig.bench.spheresDiffer() == "region sphere 17");
    spheres.x[17] -= 1e-4f;
    spheres.radius[5] *= 0.99f;
    CHECK(rig.bench.spheresDiffer() == "region sphere 5");
    spheres.radius[5] /= 0.99f;
    spheres.source[9] = spheres.source[8];
    CHECK(rig.bench.spheresDiffer() == "region sphere 9");
}

TEST_CASE("Colour of a second camera is looked up through occlusion cells, and both match their twins") {
    const gpu::Instance instance{testing::Vulkan::validation()};
    gpu::Device device{instance, "llvmpipe"};
    const FrameSequence source = twoCameraFrames("tank", 160, 120, 1);
    const SampleFrame& image = source.frames.front();
    FrameBench bench(device, studyScene({}), source.camera);
    bench.run(image);
    REQUIRE(bench.plan().occlusion);
    CHECK(bench.differsFromTwins(image).empty());
    SampleFrame near = image; // gives a smaller cell depth
    near.depth[60 * 160 + 80] = static_cast<uint16_t>(near.depth[60 * 160 + 80] / 2);
    CHECK(bench.differsFromTwins(near).starts_with("occlusion cell "));
    SampleFrame grey = image; // no pixel has its class any more
    std::fill(grey.colour.begin(), grey.colour.end(), 0xff808080u);
    CHECK(bench.differsFromTwins(grey).starts_with("class bits of pixel "));
}

TEST_CASE(
    "The second camera, 25 mm from the first, sees the same surfaces except those that are hidden from it") {
    const gpu::Instance instance{testing::Vulkan::validation()};
    gpu::Device device{instance, "llvmpipe"};
    const FrameSequence one = analyticFrames("tank", 320, 240, 1), two = twoCameraFrames("tank", 320, 240, 1);
    CHECK(glm::length(two.camera.colourTdepth.position) > 0.020);
    CHECK(glm::length(two.camera.colourTdepth.position) < 0.030);
    CHECK(two.frames.front().depth == one.frames.front().depth);
    const auto masksOf = [&](const CameraInfo& camera, const SampleFrame& image) {
        FrameBench bench(device, studyScene({}), camera);
        bench.run(image);
        return bench.masks();
    };
    const auto own = masksOf(one.camera, one.frames.front());
    CameraInfo nowhere = two.camera; // as if both were at one position
    nowhere.colourTdepth = {};
    const auto seen = masksOf(two.camera, two.frames.front()), astray = masksOf(nowhere, two.frames.front());
    size_t marked = 0, missed = 0, wrong = 0;
    for (size_t i = 0; i < own.size(); ++i) {
        marked += own[i] != 0 ? 1 : 0;
        missed += own[i] != 0 && seen[i] != own[i] ? 1 : 0;
        wrong += own[i] != 0 && astray[i] != own[i] ? 1 : 0;
    }
    CHECK(marked > 1000);
    CHECK(missed > marked / 500);
    CHECK(missed < marked / 4);
    CHECK(wrong > 2 * missed);
}

TEST_CASE("A bench with a self-filter removes the arm's points, and guidance matches its points") {
    const gpu::Instance instance{testing::Vulkan::validation()};
    gpu::Device device{instance, "llvmpipe"};
    const FrameSequence source = wallFrame(160, 120, 0.5);
    Scene scene = studyScene({});
    scene.fixtures.back().largestPart = true, scene.fixtures.back().trim = 0.1;
    scene.fixtures.back().minCount = 10;
    FrameBench bench(device, scene, source.camera, [](Plan& plan) { plan.selfFilter = true; });
    bench.run(source.frames.front());
    const auto before = bench.masks();
    bench.setArm({{{dvec3(0.0, -0.1, 0.8), 0.08}}, {1}});
    bench.run(source.frames.front());
    CHECK(bench.masks() != before);
    CHECK(bench.differsFromTwins(source.frames.front()).empty());
    CHECK(bench.guidanceDiffers().empty());
    auto& guidance = const_cast<std::vector<GuidancePose>&>(bench.set().host.guidance);
    REQUIRE(guidance.size() == 1);
    REQUIRE(guidance[0].count > 100);
    guidance[0].position.x += 1e-4;
    CHECK(bench.guidanceDiffers() == "guidance of 'yellow'");
}

TEST_CASE("An unchanged frame takes no device time and publishes nothing") {
    const gpu::Instance instance{testing::Vulkan::validation()};
    gpu::Device device{instance, "llvmpipe"};
    const FrameSequence source = wallFrame(160, 120, 0.5);
    FrameBench bench(device, studyScene({}), source.camera);
    bench.holdStill();
    CHECK(!bench.run(source.frames.front()).unchanged);
    const uint64_t generation = bench.set().host.generation;
    CHECK(bench.run(source.frames.front()).unchanged);
    const FrameCost cost = bench.measure(source.frames, {5, 5, 0.0});
    CHECK(bench.set().host.generation == generation);
    CHECK(!cost.frame.gpu);
    CHECK(!cost.frame.submit);
    CHECK(cost.total.count == 5);
    FrameBench fresh(device, studyScene({}), source.camera);
    const FrameCost whole = fresh.measure(source.frames, {5, 5, 0.0});
    CHECK(whole.frame.submit.count == 5);
}

TEST_CASE("The wall's noise has the simulated camera's sigma at 0.8 m, and every pixel has a reading") {
    const FrameSequence noisy = wallFrame(320, 240, 1.0, WallNoise::Sensor),
                        smooth = wallFrame(320, 240, 1.0);
    const auto& a = noisy.frames.front().depth;
    const auto& b = smooth.frames.front().depth;
    double squares = 0.0, sum = 0.0;
    for (size_t i = 0; i < a.size(); ++i) {
        const double e = (a[i] - b[i]) * noisy.camera.metresPerUnit;
        squares += e * e, sum += e;
        CHECK((a[i] != 0 && std::abs(e) < 0.003));
    }
    const double count = static_cast<double>(a.size());
    CHECK(std::sqrt(squares / count) / (0.3 * depthSigma(0.8)) == doctest::Approx(1.0).epsilon(0.02));
    CHECK(std::abs(sum / count) < 1e-5);
}

TEST_CASE("Thinning keeps three quarters of a noisy wall's points at 640x480 and less than a third of a "
          "smooth one's") {
    const gpu::Instance instance{testing::Vulkan::validation()};
    gpu::Device device{instance, "llvmpipe"};
    const auto left = [&](WallNoise noise) {
        const FrameSequence source = wallFrame(640, 480, 1.0, noise);
        FrameBench bench(device, studyScene({}), source.camera);
        bench.run(source.frames.front());
        return static_cast<double>(bench.set().host.spheres.size()) / (640.0 * 480.0);
    };
    CHECK(left(WallNoise::Sensor) == doctest::Approx(0.77).epsilon(0.03));
    CHECK(left(WallNoise::None) == doctest::Approx(0.26).epsilon(0.03));
}

TEST_CASE("Half precision rounds to nearest, or up for bounds") {
    for (const double value : {0.0, 1.0, 0.5, 65504.0, 6e-8, 0.0312, 1.0009765625, 0.8, 3.14159}) {
        CAPTURE(value);
        const float single = static_cast<float>(value), half = widened(halved(single));
        CHECK(std::abs(half - single) <= std::max(6e-8f, single * 0x1p-11f));
        const float up = widened(halvedUp(value));
        CHECK(static_cast<double>(up) >= value);
        CHECK(static_cast<double>(up) <= value * (1.0 + 0x1p-10) + 6e-8);
        CHECK(widened(halved(-single)) == -half);
    }
    CHECK(widened(halved(1.0f + 0x1p-11f)) == 1.0f); // a tie rounds to even
    CHECK(widened(halvedUp(1.0 + 0x1p-12)) == 1.0f + 0x1p-10f);
}
