// SPDX-License-Identifier: Apache-2.0
// Every nth column and row of a camera: pixels, lenses, colour formats, and the lifetime of the source's
// frames.
#include "devices/decimated/decimated_camera.h"

#include "tests/devices/one_frame.h"

#include <cmath>
#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::testing;

namespace {

CameraInfo camera(uint32_t width, uint32_t height) {
    CameraInfo info;
    info.depth = {
        .width = width, .height = height, .fx = 60, .fy = 61, .cx = 0.5 * width, .cy = 0.5 * height};
    info.colour = info.depth;
    return info;
}

// Pixel values that are different everywhere.
template <class Value>
std::vector<Value> counted(size_t count, Value begin) {
    std::vector<Value> list;
    for (size_t i = 0; i < count; ++i) {
        list.push_back(static_cast<Value>(begin + i * 7));
    }
    return list;
}

uint32_t rounded(uint32_t size, uint32_t n) {
    return (size + n - 1) / n;
}

} // namespace

TEST_CASE("A decimated camera delivers every nth pixel, and its lens sees them along the same rays") {
    for (const auto& [width, height] : {std::pair(1u, 1u), std::pair(7u, 5u), std::pair(64u, 48u)}) {
        for (const uint32_t n : {2u, 3u, 8u}) {
            CAPTURE(n);
            const CameraInfo full = camera(width, height);
            const auto depth = counted<uint16_t>(full.depth.pixels(), 1000);
            const auto colour = counted<uint32_t>(full.depth.pixels(), 0xff000000u);
            auto one = std::make_unique<OneFrame>(full, depth, colour);
            const OneFrame& source = *one;
            DecimatedCamera small(std::move(one), n);
            const Intrinsics& lens = small.info().depth;
            CHECK(lens.width == rounded(width, n));
            CHECK(lens.height == rounded(height, n));
            CHECK(small.info().colour.pixels() == lens.pixels());
            CHECK(small.info().decimation == n);
            const auto frame = small.next();
            REQUIRE(frame);
            CHECK(source.returned == 1); // nothing of it is in use
            REQUIRE((*frame)->depth.size() == lens.pixels());
            for (uint32_t i = 0; i < lens.pixels(); ++i) {
                const uint32_t u = i % lens.width, v = i / lens.width, from = n * v * width + n * u;
                REQUIRE((*frame)->depth[i] == depth[from]);
                REQUIRE((*frame)->colour[i] == colour[from]);
                const glm::dvec2 ray = lens.ray(u, v), whole = full.depth.ray(n * u, n * v);
                REQUIRE(std::hypot(ray.x - whole.x, ray.y - whole.y) < 1e-12);
            }
            CHECK(!small.next());
        }
    }
}

TEST_CASE("A decimated YUYV camera delivers the colours that the unpacked image has at these pixels") {
    CameraInfo full = camera(10, 5);
    full.colourFormat = ColourFormat::Yuyv;
    const auto words = counted<uint32_t>(full.depth.pixels() / 2, 0x40803010u);
    std::vector<uint32_t> rgba(full.depth.pixels());
    unpackColour({ColourFormat::Yuyv, 10, 5, std::as_bytes(std::span(words))}, rgba);
    DecimatedCamera small(std::make_unique<OneFrame>(full, counted<uint16_t>(50, 1), words), 3);
    CHECK(small.info().colourFormat == ColourFormat::Rgba);
    const auto frame = small.next();
    REQUIRE(frame);
    CHECK(!(*frame)->isRaw());
    REQUIRE((*frame)->colour.size() == 4 * 2);
    for (uint32_t i = 0; i < 8; ++i) {
        CHECK((*frame)->colour[i] == rgba[3 * (i / 4) * 10 + 3 * (i % 4)]);
    }
}

TEST_CASE("Colour with a lens of its own stays as it is, and its frame is held as long as it is used") {
    for (const ColourFormat format : {ColourFormat::Rgba, ColourFormat::Yuyv}) {
        CameraInfo full = camera(6, 4);
        full.registered = false;
        full.colourFormat = format;
        full.colour.width = 20;
        const auto colour = counted<uint32_t>(full.colourBytes() / 4, 5);
        auto one = std::make_unique<OneFrame>(full, counted<uint16_t>(24, 1), colour);
        const OneFrame& source = *one;
        DecimatedCamera small(std::move(one), 2);
        CHECK(small.info().colour.width == 20);
        CHECK(small.info().colourFormat == format);
        {
            const auto frame = small.next();
            REQUIRE(frame);
            CHECK((*frame)->colourBytes().size() == 4 * colour.size());
            CHECK((*frame)->colourBytes().back() == std::as_bytes(std::span(colour)).back());
            CHECK(source.returned == 0);
        }
        CHECK(source.returned == 1);
    }
}

TEST_CASE("A decimated camera without colour delivers depth alone") {
    CameraInfo full = camera(9, 4);
    full.hasColour = false;
    DecimatedCamera small(std::make_unique<OneFrame>(full, counted<uint16_t>(36, 1)), 4);
    const auto frame = small.next();
    REQUIRE(frame);
    CHECK((*frame)->depth.size() == 3);
    CHECK((*frame)->colour.empty());
}
