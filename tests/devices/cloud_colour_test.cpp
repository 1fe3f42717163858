// SPDX-License-Identifier: Apache-2.0
// Colour of PCD files in every form of their fields.
#include "devices/pcd/pcd_camera.h"
#include "tests/devices/recorded_folder.h"

#include <doctest/doctest.h>

using namespace fathom;

namespace {

// Plays the tilted wall in ASCII with these words behind x, y and z of each point, and fields that state them.
// Returns the colour of pixel 5, 0 without colour.
uint32_t colourOfFields(const std::string& fields, const std::string& sizes, const std::string& types,
                        const std::string& counts, const std::string& words) {
    const TemporaryFolder folder;
    std::string text = "FIELDS x y z " + fields + "\nSIZE 4 4 4 " + sizes + "\nTYPE F F F " + types +
                       "\nCOUNT 1 1 1 " + counts + "\nWIDTH 9\nHEIGHT 7\nPOINTS 63\nDATA ascii\n";
    for (uint32_t i = 0; i < 63; ++i) {
        const uint32_t column = i % 9, row = i / 9;
        const double z = 1.0 + 0.05 * column, x = (column - 4.0) / 10.0 * z, y = (row - 3.0) / 10.0 * z;
        text += std::to_string(x) + " " + std::to_string(y) + " " + std::to_string(z) + " " + words + "\n";
    }
    folder.write("a.pcd", text);
    PcdCamera camera(folder.path() / "a.pcd");
    return camera.info().hasColour ? (*camera.next())->colour[5] : 0;
}

} // namespace

TEST_CASE("Colour of a cloud may be three values of one field, and levels of any number of bytes") {
    constexpr uint32_t kExpected = 0xff140ac8u;
    CHECK(colourOfFields("rgb", "1", "U", "3", "200 10 20") == kExpected);
    CHECK(colourOfFields("rgba", "1", "U", "4", "200 10 20 7") == kExpected);
    CHECK(colourOfFields("rgb", "4", "F", "3", "200 10 20") == kExpected);
    CHECK(colourOfFields("rgb", "4", "F", "3", "1 0 0.5") == 0xff8000ffu);
    CHECK(colourOfFields("rgb", "2", "U", "3", "51400 2570 5140") == kExpected);
    for (const char* size : {"2 2 2", "4 4 4"}) {
        for (const char* type : {"U U U", "I I I"}) {
            CHECK(colourOfFields("r g b", size, type, "1 1 1", "200 10 20") == kExpected);
        }
        CHECK(colourOfFields("red green blue", size, "U U U", "1 1 1", "51400 2570 5140") == kExpected);
    }
    CHECK(colourOfFields("r g b", "4 4 4", "U U U", "1 1 1", "70000 0 0") == 0); // of unknown full scale
    CHECK(colourOfFields("rgb", "4", "U", "1", "13109780") == kExpected);        // packed
}

TEST_CASE("Intensity of whole numbers is grey") {
    CHECK(colourOfFields("intensity", "1", "U", "1", "200") == 0xffc8c8c8u);
    CHECK(colourOfFields("intensity", "2", "U", "1", "65535") == 0xffffffffu);
}
