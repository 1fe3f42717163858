// SPDX-License-Identifier: Apache-2.0
// Depth whose bytes are in another order than the file states.
#include "devices/bag/open_bag.h"
#include "devices/images/byte_order.h"
#include "devices/recorded/recorded_camera.h"
#include "tests/devices/played_bag.h"

#include <algorithm>
#include <bit>
#include <random>

using namespace fathom;
using namespace fathom::testing;

namespace {

constexpr uint32_t kOrderWidth = 40, kOrderHeight = 30, kOrderPixels = kOrderWidth * kOrderHeight;

// A slanted wall with a noise of 3 mm, and a hole.
std::vector<uint16_t> slantedWall() {
    std::mt19937 random(1);
    std::vector<uint16_t> depth;
    for (uint32_t i = 0; i < kOrderPixels; ++i) {
        const uint32_t x = i % kOrderWidth, y = i / kOrderWidth;
        const auto noise = static_cast<uint32_t>(random() % 7);
        depth.push_back(static_cast<uint16_t>(x < 4 && y < 4 ? 0 : 1200 + 4 * x + 3 * y + noise));
    }
    return depth;
}

std::vector<uint16_t> swappedUnits(std::vector<uint16_t> values) {
    std::ranges::transform(values, values.begin(), [](uint16_t v) { return __builtin_bswap16(v); });
    return values;
}

template <class T>
std::string orderedBytes(const std::vector<T>& values, bool bigEndian) {
    std::string all;
    for (const T value : values) {
        std::string bytes = raw(value);
        if (bigEndian) {
            std::ranges::reverse(bytes);
        }
        all += bytes;
    }
    return all;
}

std::vector<float> inMetres(const std::vector<uint16_t>& depth) {
    std::vector<float> metres;
    for (const uint16_t value : depth) {
        metres.push_back(static_cast<float>(value) * 0.001f);
    }
    return metres;
}

// Two images of one stream: the first may decide nothing.
BagMaker orderedStream(const std::string& encoding, const std::array<std::string, 2>& images, bool stated) {
    BagMaker maker;
    double t = 1.0;
    for (const std::string& pixels : images) {
        addStream(maker, "/c/depth",
                  {.encoding = encoding,
                   .width = kOrderWidth,
                   .height = kOrderHeight,
                   .pixels = pixels,
                   .bigEndian = stated},
                  {.width = kOrderWidth, .height = kOrderHeight, .k = {40.0, 40.0, 19.5, 14.5}}, {t});
        t += 0.1;
    }
    return maker;
}

size_t saidOrder(const Camera& camera, const std::string& text) {
    const auto said = camera.warnings();
    return static_cast<size_t>(std::ranges::count_if(
        said, [&](const std::string& line) { return line.find(text) != std::string::npos; }));
}

// Organised cloud of ROS 1: a plane 1.2 m away that is turned a little.
std::string orderedCloud(double t, bool stated, bool bigEndian) {
    Out out;
    out.bytes = stampedHeader(t, "camera");
    out.put(kOrderHeight).put(kOrderWidth).put(uint32_t{3});
    for (uint32_t i = 0; i < 3; ++i) {
        out.text(std::string(1, static_cast<char>('x' + i))).put(4 * i).put(uint8_t{7}).put(uint32_t{1});
    }
    std::vector<float> points;
    for (uint32_t i = 0; i < kOrderPixels; ++i) {
        const auto u = static_cast<float>(i % kOrderWidth), v = static_cast<float>(i / kOrderWidth);
        const float z = 1.2f + 0.003f * u;
        points.insert(points.end(), {z * (u - 19.5f) / 40.0f, z * (v - 14.5f) / 40.0f, z});
    }
    out.put(static_cast<uint8_t>(stated)).put(uint32_t{12}).put(12 * kOrderWidth);
    return out.text(orderedBytes(points, bigEndian)).put(uint8_t{1}).bytes;
}

} // namespace

TEST_CASE("The byte order of depth is judged wrong only if the other order is far smoother") {
    const std::vector<uint16_t> wall = slantedWall();
    CHECK(orderOfUnits(wall, kOrderWidth) == ByteOrder::AsStated);
    CHECK(orderOfUnits(swappedUnits(wall), kOrderWidth) == ByteOrder::Swapped);
    CHECK(orderOfUnits(swappedUnits({wall.begin() + 400, wall.begin() + 600}), kOrderWidth) ==
          ByteOrder::Unknown); // few
    std::mt19937 random(2);
    std::vector<uint16_t> noise, eightBits, nineBits, levels;
    for (const uint16_t value : wall) {
        noise.push_back(static_cast<uint16_t>(random()));
        eightBits.push_back(static_cast<uint16_t>((value & 0xffu) << 8u));
        nineBits.push_back(static_cast<uint16_t>((value & 0x1ffu) << 7u));
        levels.push_back(random() % 2 == 0 ? 1000 : 1256); // 0x03e8, 0x04e8: neighbours if swapped
    }
    CHECK(orderOfUnits(std::vector<uint16_t>(kOrderPixels, 0x2003), kOrderWidth) == ByteOrder::Unknown);
    for (const auto& values : {noise, eightBits, nineBits, levels}) {
        CHECK(orderOfUnits(values, kOrderWidth) != ByteOrder::Swapped);
    }
    for (const auto& values : {noise, eightBits, levels}) {
        CHECK(orderOfUnits(swappedUnits(values), kOrderWidth) != ByteOrder::Swapped);
    }
}

TEST_CASE("Floating-point depth in the wrong order is judged by how many of its values are lengths") {
    std::mt19937 random(3);
    OrderOfReals right, wrong, noise, few, micrometres;
    for (const float value : inMetres(slantedWall())) {
        const auto swapped = [](float v) {
            return double{std::bit_cast<float>(__builtin_bswap32(std::bit_cast<uint32_t>(v)))};
        };
        right.add(double{value}, swapped(value));
        wrong.add(swapped(value), double{value});
        micrometres.add(double{value * 1e6f}, swapped(value * 1e6f));
        const auto any = std::bit_cast<float>(static_cast<uint32_t>(random()));
        noise.add(double{any}, swapped(any));
    }
    for (int i = 0; i < 200; ++i) {
        few.add(1e-40, 1.0);
    }
    CHECK(right.order() == ByteOrder::AsStated);
    CHECK(wrong.order() == ByteOrder::Swapped);
    CHECK(noise.order() == ByteOrder::Unknown);
    CHECK(few.order() == ByteOrder::Unknown);
    CHECK(micrometres.order() != ByteOrder::Swapped);
}

TEST_CASE("Images whose is_bigendian is wrong are played in their own order, with one warning") {
    const TemporaryFolder folder;
    const std::vector<uint16_t> wall = slantedWall(), flat(kOrderPixels, 1250);
    const size_t last = kOrderPixels - 1;
    for (const bool bigEndian : {false, true}) {
        for (const bool stated : {false, true}) {
            for (const bool metres : {false, true}) {
                CAPTURE(bigEndian);
                CAPTURE(stated);
                CAPTURE(metres);
                const BagMaker maker =
                    metres ? orderedStream("32FC1",
                                           {orderedBytes(inMetres(flat), bigEndian),
                                            orderedBytes(inMetres(wall), bigEndian)},
                                           stated)
                           : orderedStream("16UC1",
                                           {orderedBytes(flat, bigEndian), orderedBytes(wall, bigEndian)},
                                           stated);
                BagCamera camera = playStreams(folder, maker);
                CHECK(firstDepth(camera) == doctest::Approx(1.25)); // although this image decides nothing
                const auto frame = camera.next();
                REQUIRE(frame);
                CHECK((*frame)->depth[0] == 0);
                CHECK((*frame)->depth[last] * camera.info().metresPerUnit ==
                      doctest::Approx(0.001 * wall[last]));
                CHECK(saidOrder(camera,
                                stated ? "/c/depth: is_bigendian is 1, but its values are plausible only "
                                         "as little-endian ones"
                                       : "/c/depth: is_bigendian is 0, but its values are plausible only "
                                         "as big-endian ones") == (stated == bigEndian ? 0 : 1));
                CHECK(saidOrder(camera, "is_bigendian") == (stated == bigEndian ? 0 : 1));
            }
        }
    }
}

TEST_CASE("Clouds whose is_bigendian is wrong are played in their own order, with one warning") {
    const TemporaryFolder folder;
    for (const bool bigEndian : {false, true}) {
        for (const bool stated : {false, true}) {
            CAPTURE(bigEndian);
            CAPTURE(stated);
            BagMaker maker;
            for (const double t : {1.0, 1.1}) {
                maker.add("/points", "sensor_msgs/PointCloud2", t, orderedCloud(t, stated, bigEndian));
            }
            folder.write("a.bag", maker.bag());
            const auto camera = openBag(folder.path() / "a.bag");
            CHECK(camera->info().depth.fx == doctest::Approx(40.0).epsilon(1e-3));
            const auto frame = camera->next();
            REQUIRE(frame);
            CHECK((*frame)->depth[0] * camera->info().metresPerUnit == doctest::Approx(1.2));
            CHECK(saidOrder(*camera, "/points: is_bigendian is ") == (stated == bigEndian ? 0 : 1));
        }
    }
}

TEST_CASE("PGM images with the least significant byte first are read so, with one warning") {
    const std::vector<uint16_t> wall = slantedWall(), flat(kOrderPixels, 1250);
    for (const char* most : {"65535", "2047"}) { // the stated maximum counts for the values as they are read
        for (const bool bigEndian : {true, false}) {
            const TemporaryFolder folder;
            std::filesystem::create_directories(folder.path() / "depth");
            const std::string head = std::string("P5 40 30 ") + most + "\n";
            folder.write("depth/0.pgm", head + orderedBytes(flat, bigEndian));
            folder.write("depth/1.pgm", head + orderedBytes(wall, bigEndian));
            folder.write("depth.txt", "0 depth/0.pgm\n0.1 depth/1.pgm\n");
            folder.write("intrinsics.json",
                         R"({"width": 40, "height": 30, "fx": 40, "fy": 40, "cx": 19.5, "cy": 14.5,
                             "has_color": false, "depth_scale_m_per_unit": 0.001})");
            RecordedCamera camera(folder.path());
            for (const auto& values : {flat, wall}) {
                const auto frame = camera.next();
                REQUIRE(frame);
                CHECK(std::ranges::equal((*frame)->depth, values));
            }
            CHECK(saidOrder(camera, "1.pgm: PGM has the most significant byte first, but") ==
                  (bigEndian ? 0 : 1));
            CHECK(camera.warnings().size() == (bigEndian ? 0 : 1));
        }
    }
}
