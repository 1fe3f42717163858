// SPDX-License-Identifier: Apache-2.0
#include "devices/simulated/simulated_camera.h"

#include "engine/types/error.h"

#include <cmath>
#include <cstdint>
#include <doctest/doctest.h>
#include <glm/geometric.hpp>
#include <unistd.h>
#include <vector>

using namespace fathom;

namespace {

struct Seen {
    std::vector<uint16_t> depth;
    std::vector<uint32_t> colour;
    bool operator==(const Seen&) const = default;
};

Seen copyOf(const Frame& frame) {
    return {{frame->depth.begin(), frame->depth.end()}, {frame->colour.begin(), frame->colour.end()}};
}

std::vector<Seen> film(SimulatedCameraOptions options, const std::string& scene = "tank") {
    SimulatedCamera camera(*analyticScene(scene), options);
    std::vector<Seen> images;
    while (std::optional<Frame> frame = camera.next()) {
        images.push_back(copyOf(*frame));
    }
    return images;
}

SimulatedCameraOptions small() {
    SimulatedCameraOptions options;
    options.width = 161, options.height = 119, options.frames = 3;
    return options;
}

} // namespace

TEST_CASE("A frame has the same bits from 1, 2 and 5 threads and in every run") {
    SimulatedCameraOptions options = small();
    options.threads = 1;
    const std::vector<Seen> one = film(options);
    REQUIRE(one.size() == 3);
    CHECK(one[0] != one[1]);
    for (const uint32_t threads : {1u, 2u, 5u}) {
        options.threads = threads;
        CHECK(film(options) == one);
    }
    options.firstFrame = 2; // the last frame alone, without those before it
    CHECK(film(options) == std::vector<Seen>{one[2]});
    options.firstFrame = 0, options.seed = 2;
    CHECK(film(options) != one);
}

TEST_CASE("A frame depends only on its index: a static camera without noise repeats itself, one with noise "
          "does not") {
    SimulatedCameraOptions options = small();
    options.motion = false;
    const std::vector<Seen> noisy = film(options);
    CHECK(noisy[0] != noisy[1]);
    options.noise = options.water = false;
    const std::vector<Seen> still = film(options);
    CHECK(still[0] == still[1]);
    CHECK(still[0] == still[2]);
}

TEST_CASE("Without noise and water the depth image is the exact depth rounded to units of either size") {
    for (const double unit : {0.001, 0.0001}) {
        SimulatedCameraOptions options = small();
        options.noise = options.water = false;
        options.metresPerUnit = unit;
        SimulatedCamera camera(*analyticScene("tank"), options);
        while (std::optional<Frame> frame = camera.next()) {
            const SimulatedCamera::ExactView truth = camera.exactView((*frame)->index);
            double worst = 0.0;
            for (size_t i = 0; i < truth.depth.size(); ++i) {
                worst = std::fmax(worst, std::abs((*frame)->depth[i] * unit - truth.depth[i]));
            }
            CHECK(worst <= 0.5000001 * unit);
            CHECK(worst > 0.3 * unit);
        }
    }
}

TEST_CASE(
    "Depth noise has the promised spread, no bias, and the promised share of pixels without a reading") {
    SimulatedCameraOptions options;
    options.width = 320, options.height = 240, options.frames = 6, options.metresPerUnit = 0.0001;
    options.dropShare = 0.02;
    SimulatedCamera camera(*analyticScene("plane"), options);
    double sum = 0.0, square = 0.0, cube = 0.0, beside = 0.0;
    uint64_t count = 0, dropped = 0, pairs = 0;
    while (std::optional<Frame> frame = camera.next()) {
        const SimulatedCamera::ExactView truth = camera.exactView((*frame)->index);
        double before = 0.0;
        for (size_t i = 0; i < truth.depth.size(); ++i) {
            const double z = truth.depth[i];
            REQUIRE(z > 0.0);
            if ((*frame)->depth[i] == 0) {
                ++dropped;
                before = 0.0;
                continue;
            }
            const double e =
                ((*frame)->depth[i] * 0.0001 - z) / (SimulatedCamera::kDepthSigmaShare * depthSigma(z));
            sum += e, square += e * e, cube += e * e * e, ++count;
            beside += before * e, pairs += before != 0.0;
            before = e;
        }
    }
    const double n = static_cast<double>(count);
    MESSAGE("mean ", sum / n, " sigma, spread ", std::sqrt(square / n), ", skew ", cube / n, ", neighbours ",
            beside / static_cast<double>(pairs), ", dropped ",
            static_cast<double>(dropped) / (n + static_cast<double>(dropped)));
    CHECK(std::abs(sum / n) < 0.01);
    CHECK(std::sqrt(square / n) == doctest::Approx(1.0).epsilon(0.02));
    CHECK(std::abs(cube / n) < 0.02);
    CHECK(std::abs(beside / static_cast<double>(pairs)) < 0.01);
    CHECK(static_cast<double>(dropped) / (n + static_cast<double>(dropped)) ==
          doctest::Approx(0.02).epsilon(0.05));
}

TEST_CASE("Flying pixels lie between the two surfaces of a silhouette and nowhere else") {
    SimulatedCameraOptions options;
    options.width = 320, options.height = 240, options.frames = 4;
    SimulatedCamera camera(*analyticScene("sphere"), options);
    uint32_t flying = 0, far = 0;
    while (std::optional<Frame> frame = camera.next()) {
        const SimulatedCamera::ExactView truth = camera.exactView((*frame)->index);
        for (uint32_t v = 1; v + 1 < options.height; ++v) {
            for (uint32_t u = 1; u + 1 < options.width; ++u) {
                const size_t i = v * options.width + u;
                const double z = (*frame)->depth[i] * 0.001;
                double low = truth.depth[i], high = low;
                for (const size_t other : {i - 1, i + 1, i - options.width, i + options.width}) {
                    low = std::fmin(low, truth.depth[other]), high = std::fmax(high, truth.depth[other]);
                }
                const double slack = 5.0 * SimulatedCamera::kDepthSigmaShare * depthSigma(high) + 0.001;
                flying += z > 0.0 && std::abs(z - truth.depth[i]) > 2.0 * slack;
                far += z > 0.0 && (z < low - slack || z > high + slack);
            }
        }
    }
    MESSAGE(flying, " flying pixels in ", options.frames, " frames");
    CHECK(far == 0);
    CHECK(flying > 200);
}

TEST_CASE("Water takes red first, hides what is far, and puts single near specks into the frame") {
    SimulatedCameraOptions options;
    options.frames = 1, options.noise = false;
    const Seen wet = film(options)[0];
    options.water = false;
    const Seen dry = film(options)[0];
    double red[2] = {0, 0}, blue[2] = {0, 0};
    uint32_t specks = 0;
    for (size_t i = 0; i < wet.depth.size(); ++i) {
        red[0] += dry.colour[i] & 255, red[1] += wet.colour[i] & 255;
        blue[0] += dry.colour[i] >> 16 & 255, blue[1] += wet.colour[i] >> 16 & 255;
        specks += wet.depth[i] != dry.depth[i];
        CHECK_FALSE(wet.depth[i] > dry.depth[i]);
    }
    CHECK(red[1] / red[0] < 0.85);
    CHECK(red[1] / red[0] < 0.9 * blue[1] / blue[0]);
    CHECK(specks > 20);
    CHECK(specks < 200);
    CHECK(film(options, "sphere") == [&] {
        auto o = options;
        o.water = true;
        return film(o, "sphere");
    }());
}

TEST_CASE("The camera's pose starts at the given one, sways slowly within 20 mm and 1.5 degrees and is in "
          "every frame") {
    SimulatedCameraOptions options;
    options.width = options.height = 1, options.frames = 600;
    options.baseTscene = {{100.0, -2.0, 0.5}, rotationExp({0.1, 0.2, 0.3})};
    SimulatedCamera camera(*analyticScene("plane"), options);
    double farthest = 0.0, steepest = 0.0, fastest = 0.0;
    uint32_t frames = 0;
    dvec3 before(0.0);
    while (std::optional<Frame> frame = camera.next()) {
        REQUIRE((*frame)->baseTcamera.has_value());
        const Pose sway = inverse(options.baseTscene) * *(*frame)->baseTcamera;
        const dvec3 turn = rotationLog(sway.rotation);
        CHECK((*frame)->index == frames);
        CHECK((*frame)->captureTime == doctest::Approx(frames / 30.0).epsilon(1e-12));
        if (frames == 0) {
            CHECK(glm::length(sway.position) < 1e-12);
            CHECK(glm::length(turn) < 1e-12);
        }
        for (int axis = 0; axis < 3; ++axis) {
            farthest = std::fmax(farthest, std::abs(sway.position[axis]));
            steepest = std::fmax(steepest, std::abs(turn[axis]) * 180.0 / std::acos(-1.0));
        }
        fastest = std::fmax(fastest, frames == 0 ? 0.0 : glm::length(sway.position - before) * 30.0);
        before = sway.position, ++frames;
    }
    CHECK(frames == 600);
    CHECK_FALSE(camera.next().has_value());
    CHECK(farthest == doctest::Approx(0.020).epsilon(0.02));
    CHECK(steepest == doctest::Approx(1.5).epsilon(0.02));
    CHECK(fastest < 0.03);
}

TEST_CASE("Frame memory is page-aligned, is released when the lease ends, and is not touched before") {
    SimulatedCameraOptions options = small();
    options.frames = 40;
    SimulatedCamera camera(*analyticScene("sphere"), options);
    const auto page = static_cast<uintptr_t>(::sysconf(_SC_PAGESIZE));
    std::vector<Frame> held;
    for (uint32_t i = 0; i < Camera::kFramesInFlight; ++i) {
        held.push_back(std::move(*camera.next()));
        CHECK(reinterpret_cast<uintptr_t>(held.back()->depth.data()) % page == 0);
        CHECK(reinterpret_cast<uintptr_t>(held.back()->colour.data()) % page == 0);
    }
    const Seen first = copyOf(held[0]);
    for (int i = 0; i < 20; ++i) {
        CHECK(camera.next().has_value()); // at once given back
    }
    CHECK(copyOf(held[0]) == first);
    held.push_back(std::move(*camera.next()));
    held.push_back(std::move(*camera.next()));
    CHECK_THROWS_AS(camera.next(), Error); // kFramesInFlight + 2 slots are all there are
    held.clear();
    CHECK(camera.next().has_value());
}

TEST_CASE("Frame slots are given out once each until they come back") {
    FrameSlots none(10, true, 0);
    CHECK(none.acquire() == nullptr);
    FrameSlots slots(7, false, 3);
    FrameSlot* a = slots.acquire();
    FrameSlot* b = slots.acquire();
    FrameSlot* c = slots.acquire();
    REQUIRE((a != nullptr && b != nullptr && c != nullptr));
    CHECK((a != b && b != c && a != c));
    CHECK(slots.acquire() == nullptr);
    CHECK(slots.inFlight() == 3);
    CHECK(a->depth().size() == 7);
    CHECK(a->colour().empty());
    b->release();
    CHECK(slots.inFlight() == 2);
    CHECK(slots.acquire() == b);
    CHECK(wholePages(0) == wholePages(1));
    CHECK(wholePages(wholePages(1) + 1) == 2 * wholePages(1));
}

TEST_CASE("Sizes of one pixel and odd sizes work; sizes and options out of range are rejected") {
    for (const auto& [width, height] : {std::pair{1u, 1u}, {17u, 1u}, {1u, 33u}, {163u, 97u}}) {
        SimulatedCameraOptions options;
        options.width = width, options.height = height, options.frames = 1,
        options.noise = options.water = false;
        options.focal = 150.0;
        SimulatedCamera camera(*analyticScene("plane"), options);
        const std::optional<Frame> frame = camera.next();
        REQUIRE(frame.has_value());
        CHECK((*frame)->depth.size() == size_t{width} * height);
        for (const uint16_t depth : (*frame)->depth) {
            CHECK(depth > 400);
        }
    }
    const auto refused = [](auto change) {
        SimulatedCameraOptions options;
        change(options);
        CHECK_THROWS_AS(SimulatedCamera(*analyticScene("plane"), options), Error);
    };
    refused([](auto& o) { o.width = 0; });
    refused([](auto& o) { o.height = 2161; });
    refused([](auto& o) { o.threads = 0; });
    refused([](auto& o) { o.metresPerUnit = 0.0; });
    refused([](auto& o) { o.dropShare = 1.5; });
    SimulatedCameraOptions empty = small();
    empty.frames = 0;
    CHECK(film(empty).empty());
}
