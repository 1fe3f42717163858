// SPDX-License-Identifier: Apache-2.0
// Where a camera stands still, how large its noise is, and the mean image.
#include "apps/tune/still_part.h"
#include "devices/simulated/counter_noise.h"

#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::tune;

namespace {

constexpr uint32_t kWide = 96, kHigh = 64;

// A slanted wall at 1 m in units of 0.1 mm, with noise of `sigma` units.
SampleFrame wall(uint32_t frame, double sigma, double nearer = 0.0) {
    static const NormalTable kNormal;
    SampleFrame image;
    for (uint32_t i = 0; i < kWide * kHigh; ++i) {
        const uint64_t bits = counterBits(1, frame, i, NoisePurpose::Depth);
        const double z = 10000.0 + 2.0 * (i % kWide) - nearer + sigma * kNormal(static_cast<uint32_t>(bits));
        image.depth.push_back(static_cast<uint16_t>(std::lround(z)));
        image.colour.push_back(0xff000000u | (100u + frame % 2));
    }
    return image;
}

FrameSequence sequence() {
    FrameSequence source;
    source.camera.depth = {kWide, kHigh, 90.0, 90.0, 47.5, 31.5};
    source.camera.colour = source.camera.depth;
    source.camera.metresPerUnit = 0.0001;
    return source;
}

} // namespace

TEST_CASE("Noise is found within one image, also on a slanted surface, and is at least that of rounding") {
    const FrameSequence source = sequence();
    const DepthNoise noise = noiseWithin(source.camera, wall(0, 8.0));
    CHECK(noise.sigma == doctest::Approx(0.0008).epsilon(0.05));
    CHECK(noise.range == doctest::Approx(1.0095).epsilon(0.01));
    CHECK(noiseWithin(source.camera, wall(0, 0.0)).sigma == doctest::Approx(0.0001 / std::sqrt(12.0)));
    SampleFrame empty;
    empty.depth.assign(kWide * kHigh, 0);
    CHECK(noiseWithin(source.camera, empty).range == 0.0);
}

TEST_CASE("Noise over time is found from a camera that moves steadily, and when neighbours are alike") {
    FrameSequence source = sequence();
    for (uint32_t k = 0; k < 12; ++k) {
        source.frames.push_back(wall(k, 8.0, 20.0 * k));
        std::vector<uint16_t>& depth = source.frames.back().depth;
        for (uint32_t i = 0; i < depth.size(); i += 4) { // four pixels in a row share their noise
            for (uint32_t j = 1; j < 4; ++j) {
                depth[i + j] = static_cast<uint16_t>(depth[i] + 2 * j);
            }
        }
    }
    CHECK(noiseWithin(source.camera, source.frames.front()).sigma < 0.0005);
    CHECK(noiseOverTime(source).sigma == doctest::Approx(0.0008).epsilon(0.1));
}

TEST_CASE("Noise is assumed when there are too few frames, or frames that show different things") {
    FrameSequence source = sequence();
    source.frames = {wall(0, 8.0)};
    const double usual = 0.3 * depthSigma(noiseWithin(source.camera, source.frames.front()).range);
    CHECK(!noiseOverTime(source).measured);
    CHECK(noiseOverTime(source).sigma == doctest::Approx(usual));
    for (uint32_t k = 1; k < 9; ++k) {
        source.frames.push_back(wall(k, 8.0, k % 2 == 0 ? 0.0 : 3000.0));
    }
    CHECK(!noiseOverTime(source).measured);
    CHECK(noiseOverTime(source).sigma == doctest::Approx(usual));
}

TEST_CASE("Frames that differ by noise alone stand still, and a move of two sigma ends the part") {
    FrameSequence source = sequence();
    for (uint32_t k = 0; k < 30; ++k) {
        source.frames.push_back(wall(k, 8.0, k < 10 ? 0.0 : 16.0));
    }
    const StillPart part = longestStill(source);
    CHECK(part.first == 10);
    CHECK(part.count == 20);
    CHECK(part.enough());
}

TEST_CASE("A camera that moves has no still part, whether its poses or its images show it") {
    FrameSequence drifting = sequence(), posed = sequence();
    for (uint32_t k = 0; k < 20; ++k) {
        drifting.frames.push_back(wall(k, 3.0, 3.0 * k));
        posed.frames.push_back(wall(k, 3.0));
        posed.frames.back().baseTcamera.position.x = 0.0008 * k;
    }
    CHECK(!longestStill(drifting).enough());
    CHECK(longestStill(posed).count == 1);
    CHECK(longestStill(sequence()).count == 0);
}

TEST_CASE("The mean image has less noise, finer units and no pixels that flicker or are seldom measured") {
    FrameSequence source = sequence();
    for (uint32_t k = 0; k < 16; ++k) {
        source.frames.push_back(wall(k, 8.0));
        source.frames.back().depth[5] = k % 4 == 0 ? 10000 : 0; // seldom
        source.frames.back().depth[6] = k % 2 == 0 ? 10000 : 6000;
    }
    const MeanImage mean = meanOf(source, longestStill(source));
    CHECK(mean.camera.metresPerUnit < 0.00003);
    CHECK(mean.image.depth[5] == 0);
    CHECK(mean.image.depth[6] == 0);
    CHECK(mean.noise.sigma == doctest::Approx(0.0008).epsilon(0.1));
    CHECK(mean.image.colour.front() == 0xff000065u); // 100 and 101 in turn: rounded up
    double squares = 0.0;
    for (uint32_t i = 7; i < kWide * kHigh; ++i) {
        const double off =
            mean.camera.metresPerUnit * mean.image.depth[i] - 1e-4 * (10000.0 + 2.0 * (i % kWide));
        squares += off * off / (kWide * kHigh);
    }
    CHECK(std::sqrt(squares) == doctest::Approx(0.0002).epsilon(0.2));
}
