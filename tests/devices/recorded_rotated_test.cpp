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
