// SPDX-License-Identifier: Apache-2.0
// Depth values whose bits are rotated, as in SUN3D, and values that look so.
#include "devices/recorded/recorded_camera.h"
#include "tests/devices/recorded_folder.h"

#include <bit>
#include <doctest/doctest.h>

using namespace fathom;

namespace {

using Values = std::vector<uint16_t>;
const SourceOptions kDepthOnly{.colour = "none"};
constexpr uint32_t kSide = 20;

// An image of kSide x kSide of these values, repeated.
void writeValues(const TemporaryFolder& folder, const Values& values) {
    folder.write("intrinsics.json", R"({"width": 20, "height": 20, "fx": 9, "fy": 9, "cx": 9, "cy": 9,
                                        "depth_scale_m_per_unit": 0.001})");
    std::vector<uint8_t> bytes;
    for (size_t i = 0; i < size_t{kSide} * kSide; ++i) {
        const uint16_t value = values[i % values.size()];
        bytes.push_back(static_cast<uint8_t>(value >> 8));
        bytes.push_back(static_cast<uint8_t>(value & 0xff));
    }
    std::filesystem::create_directories(folder.path() / "depth");
    writePng(folder.path() / "depth/1.png", kSide, kSide, 16, 0, bytes);
    folder.write("depth.txt", "0.0 depth/1.png\n");
}

Values rising(uint16_t from, uint16_t step, uint16_t count, int rotation) {
    Values values;
    for (uint16_t i = 0; i < count; ++i) {
        values.push_back(std::rotl(static_cast<uint16_t>(from + i * step), rotation));
    }
    return values;
}

} // namespace

TEST_CASE("Depth in coarse steps of millimetres is not taken for rotated values") {
    for (const uint16_t step : Values{8, 16, 32, 64}) {
        CAPTURE(step);
        const TemporaryFolder folder;
        writeValues(folder, rising(800, step, 50, 0));
        CHECK(playedDepths(folder.path(), kDepthOnly) == Values{800});
    }
}

TEST_CASE("A few pixels without a value, too far or too close do not hide that values are rotated") {
    for (const uint16_t odd : {uint16_t{65535}, std::rotl(uint16_t{20000}, 3), std::rotl(uint16_t{90}, 3)}) {
        CAPTURE(odd);
        Values values = rising(800, 7, kSide * kSide, 3);
        for (const size_t i : {1, 100, 250}) {
            values[i] = odd;
        }
        const TemporaryFolder folder;
        writeValues(folder, values);
        CHECK(playedDepths(folder.path(), kDepthOnly) == Values{800});
    }
}

TEST_CASE("That values are read as rotated is among the recording's warnings") {
    const TemporaryFolder folder;
    writeValues(folder, rising(800, 7, 50, 3));
    const auto said = RecordedCamera(folder.path(), kDepthOnly).warnings();
    REQUIRE(said.size() == 1);
    CHECK(said[0].find("rotated by three bits") != std::string::npos);
    CHECK(RecordedCamera(folder.path(), {.colour = "none", .scale = 0.001}).warnings().empty());
}

TEST_CASE(
    "Depth in any coarse step of millimetres is not taken for rotated values, whatever a few pixels hold") {
    for (const uint16_t step : Values{24, 40, 104, 1000}) {
        CAPTURE(step);
        const TemporaryFolder folder;
        Values values = rising(static_cast<uint16_t>(2000 - 2000 % step), step, 40, 0);
        writeValues(folder, values);
        CHECK(playedDepths(folder.path(), kDepthOnly) == Values{values[0]});
        CHECK(RecordedCamera(folder.path(), kDepthOnly).warnings().empty());
        values.resize(size_t{kSide} * kSide, values.back());
        values[200] = 8 * 307; // an outlier
        writeValues(folder, values);
        CHECK(playedDepths(folder.path(), kDepthOnly) == Values{values[0]});
    }
}

TEST_CASE("Multiples of eight within 8 m, which may be either, are refused with both ways to read them") {
    const TemporaryFolder folder;
    writeValues(folder, rising(2400, 8, 400, 0)); // or 300 to 699 mm, rotated
    const std::string refused = recordingRefusal(folder.path(), kDepthOnly);
    for (const char* part : {"multiples of eight", "scale=0.001 ", "scale=0.000125 "}) {
        CAPTURE(part);
        CHECK(refused.find(part) != std::string::npos);
    }
    CHECK(playedDepths(folder.path(), {.colour = "none", .scale = 0.001}) == Values{2400});
    RecordedCamera eighths(folder.path(), {.colour = "none", .scale = 0.000125});
    CHECK(eighths.next().value()->depth[0] * eighths.info().metresPerUnit == doctest::Approx(0.3));
}

TEST_CASE("Depth of the Kinect SDK with the numbers of players has a warning with the scale that reads it") {
    for (const uint16_t player : Values{1, 2, 6}) {
        CAPTURE(player);
        Values values = rising(800, 7, kSide * kSide, 3);
        for (size_t i = 0; i < values.size(); i += 4) {
            values[i] |= player;
        }
        const TemporaryFolder folder;
        writeValues(folder, values);
        RecordedCamera camera(folder.path(), kDepthOnly);
        CHECK(camera.next().value()->depth[1] == 8 * 807); // as stored
        REQUIRE(camera.warnings().size() == 1);
        CHECK(camera.warnings()[0].find("Kinect SDK") != std::string::npos);
        CHECK(camera.warnings()[0].find("scale=0.000125") != std::string::npos);
    }
}

TEST_CASE("Depth in plain millimetres has no warning about rotated bits or players") {
    const TemporaryFolder folder;
    for (const uint16_t step : Values{1, 2, 3, 4, 5, 12}) {
        CAPTURE(step);
        writeValues(folder, rising(800, step, 400, 0));
        CHECK(RecordedCamera(folder.path(), kDepthOnly).warnings().empty());
    }
}
