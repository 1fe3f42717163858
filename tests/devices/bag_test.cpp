// SPDX-License-Identifier: Apache-2.0
#include "devices/bag/bag_camera.h"

#include "devices/bag/unpack_chunk.h"
#include "devices/recorded/recorded_camera.h"
#include "engine/types/colour_copy.h"
#include "engine/types/error.h"
#include "tests/devices/bag_maker.h"
#include "tests/devices/recorded_folder.h"
#include "tests/support/refusal.h"

#include <cmath>
#include <doctest/doctest.h>
#include <spdlog/spdlog.h>

using namespace fathom;
using namespace fathom::testing;

namespace {

std::string info(double fx) {
    return infoMessage({.width = 3, .height = 2, .k = {fx, 5.0, 1.0, 0.5}});
}

std::string image(double t, const std::string& encoding, uint32_t step, const std::string& pixels) {
    return imageMessage(t, {.encoding = encoding, .width = 3, .height = 2, .step = step, .pixels = pixels});
}

// Three depth images 100 ms apart and two colour images, 3 x 2 pixels, rows with padding.
BagMaker smallBag(double colourFx = 4.0) {
    BagMaker maker;
    maker.add("/cam/depth/camera_info", "sensor_msgs/CameraInfo", 1.0, info(4.0));
    maker.add("/cam/color/camera_info", "sensor_msgs/CameraInfo", 1.0, info(colourFx));
    for (int i = 0; i < 3; ++i) {
        std::string rows;
        for (uint16_t v = 0; v < 8; ++v) {
            rows += raw(static_cast<uint16_t>(100 * (i + 1) + v));
        }
        maker.add("/cam/depth/image_rect", "sensor_msgs/Image", 1.0 + 0.1 * i,
                  image(1.0 + 0.1 * i, "16UC1", 8, rows));
    }
    for (int i = 0; i < 2; ++i) {
        const std::string rows(18, static_cast<char>(10 * (i + 1)));
        maker.add("/cam/color/image_raw", "sensor_msgs/Image", 1.02 + 0.1 * i,
                  image(1.02 + 0.1 * i, "bgr8", 9, rows));
    }
    return maker;
}

std::string bagRefusal(const std::filesystem::path& file) {
    return testing::refusalOf([&] { BagCamera camera(file); });
}

} // namespace

TEST_CASE(
    "Uncompressed, bz2 and LZ4 chunks of a bag give the same frames, paired by time and without padding") {
    const TemporaryFolder folder;
    for (const char* compression : {"none", "bz2", "lz4"}) {
        folder.write("a.bag", smallBag().bag(compression));
        BagCamera camera(folder.path() / "a.bag");
        CHECK(camera.info().registered);
        CHECK(camera.info().metresPerUnit == 0.001);
        CHECK(camera.info().depth.fx == 4.0);
        for (int i = 0; i < 2; ++i) {
            const auto frame = camera.next();
            REQUIRE(frame);
            CHECK((*frame)->captureTime == doctest::Approx(1.0 + 0.1 * i));
            CHECK((*frame)->depth[2] == 100 * (i + 1) + 2);
            CHECK((*frame)->depth[3] == 100 * (i + 1) + 4); // the first of the second row
            CHECK(coloursOf(**frame)[5] == (0xff000000u | 0x010101u * static_cast<uint32_t>(10 * (i + 1))));
        }
        CHECK_FALSE(camera.next()); // the third has no colour within 50 ms
        CHECK(camera.skipped() == 1);
    }
}

TEST_CASE("A bag that is truncated in its first chunk, of another version or without depth is rejected in "
          "one line") {
    const TemporaryFolder folder;
    const auto refused = [&](const std::string& bytes) {
        folder.write("a.bag", bytes);
        const std::string said = bagRefusal(folder.path() / "a.bag");
        CHECK(said.find('\n') == std::string::npos);
        return said;
    };
    CHECK(refused("#ROSBAG V1.2\nxxxx").find("version 2.0") != std::string::npos);
    CHECK(refused("").find("version 2.0") != std::string::npos);
    CHECK(refused(smallBag(5.0).bag("lz4")).find("extrinsics: missing") != std::string::npos);
    BagMaker none;
    none.add("/ta\nlk", "std_msgs/String\n", 1.0, "hello");
    CHECK(refused(none.bag("none")).find("no images") != std::string::npos);
    for (const char* compression : {"lz4", "bz2", "none"}) {
        const std::string whole = smallBag().bag(compression);
        const size_t chunkEnd = smallBag().chunks(compression).size();
        for (size_t keep = 0; keep < chunkEnd; keep += 97) { // never a crash, never a frame from nowhere
            const bool rejected = !refused(whole.substr(0, keep)).empty();
            CHECK((rejected || std::string(compression) == "none")); // whose whole messages are read
        }
    }
}

TEST_CASE("A bag that claims more data than its bytes can hold is rejected before memory is allocated") {
    for (const char* compression : {"lz4", "bz2"}) {
        const std::string few(100, 'x');
        const std::span<const uint8_t> packed(reinterpret_cast<const uint8_t*>(few.data()), few.size());
        CHECK_THROWS_WITH_AS(unpackChunk(compression, packed, 1u << 30),
                             "a chunk of 100 bytes cannot hold the 1073741824 that it declares", Error);
    }
}

TEST_CASE("A bag with any byte changed is either rejected or read, and never crashes the reader") {
    const TemporaryFolder folder;
    const std::string whole = smallBag().bag("lz4");
    const auto level = spdlog::get_level();
    spdlog::set_level(spdlog::level::off);
    for (size_t at = 13; at < whole.size(); at += 3) {
        std::string changed = whole;
        changed[at] = static_cast<char>(changed[at] ^ 0x5a);
        folder.write("a.bag", changed);
        try {
            BagCamera camera(folder.path() / "a.bag");
            while (camera.next()) {
            }
        } catch (const Error&) {
        }
    }
    spdlog::set_level(level);
    CHECK_THROWS_AS(unpackChunk("zip", {}, 0), Error);
}

TEST_CASE("A real RealSense bag gives the frames, lenses and extrinsics that were extracted from it") {
    if (!haveRecording("realsense_bag")) {
        return;
    }
    const auto folder = kRecordings / "realsense_bag";
    BagCamera bag(folder / "single_depth_color_640x480.bag");
    RecordedCamera recorded(folder);
    const CameraInfo &a = bag.info(), &b = recorded.info();
    CHECK_FALSE(a.registered);
    CHECK(a.metresPerUnit == doctest::Approx(0.001).epsilon(1e-12));
    CHECK(a.depth.fx == doctest::Approx(b.depth.fx).epsilon(1e-12));
    CHECK(a.colour.cy == doctest::Approx(b.colour.cy).epsilon(1e-12));
    CHECK(glm::length(a.colourTdepth.position - b.colourTdepth.position) < 1e-9);
    CHECK(std::abs(glm::dot(a.colourTdepth.rotation, b.colourTdepth.rotation)) ==
          doctest::Approx(1.0).epsilon(1e-12));
    const auto one = bag.next(), other = recorded.next();
    REQUIRE(one);
    REQUIRE(other);
    CHECK(std::equal((*one)->depth.begin(), (*one)->depth.end(), (*other)->depth.begin()));
    CHECK(coloursOf(**one) == coloursOf(**other));
    CHECK_FALSE(bag.next());
    CHECK(bag.skipped() == 1); // its second depth image is 113 ms from the one colour image
}
