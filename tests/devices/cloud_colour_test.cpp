// SPDX-License-Identifier: Apache-2.0
// Colour of PCD files and of clouds in bags, in every form of their fields.
#include "devices/bag/open_bag.h"
#include "devices/pcd/pcd_camera.h"
#include "tests/devices/bag_maker.h"
#include "tests/devices/recorded_folder.h"
#include "tests/support/mentions.h"

using namespace fathom;
using namespace fathom::testing;

namespace {

// Plays the tilted wall in ASCII with these words behind x, y and z of each point, and fields that state
// them. Returns the colour of pixel 5, 0 without colour.
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

// A field behind x, y and z: name, offset, type of sensor_msgs/PointField, count.
struct ExtraField {
    std::string name;
    uint32_t offset;
    uint8_t type;
    uint32_t count = 1;
};

// A bag with the tilted wall as clouds, one for each of the words: bytes behind x, y and z of each of its
// points.
std::unique_ptr<Camera> cloudsWith(const TemporaryFolder& folder, const std::vector<ExtraField>& fields,
                                   const std::vector<std::string>& words) {
    BagMaker maker;
    double t = 1.0;
    for (const std::string& word : words) {
        Out out{stampedHeader(t, "camera")};
        out.put(uint32_t{7}).put(uint32_t{9}).put(static_cast<uint32_t>(3 + fields.size()));
        for (uint32_t i = 0; i < 3; ++i) {
            out.text(std::string(1, static_cast<char>('x' + i))).put(4 * i).put(uint8_t{7}).put(uint32_t{1});
        }
        for (const ExtraField& field : fields) {
            out.text(field.name).put(12 + field.offset).put(field.type).put(field.count);
        }
        const auto step = static_cast<uint32_t>(12 + word.size());
        std::string points;
        for (uint32_t i = 0; i < 63; ++i) {
            const uint32_t down = i / 9;
            const auto column = static_cast<float>(i % 9), row = static_cast<float>(down);
            const float z = 1.0f + 0.05f * column;
            points += raw((column - 4.0f) / 10.0f * z) + raw((row - 3.0f) / 10.0f * z) + raw(z) + word;
        }
        out.put(uint8_t{0}).put(step).put(9 * step).text(points).put(uint8_t{1});
        maker.add("/points", "sensor_msgs/PointCloud2", t, out.bytes);
        t += 0.1;
    }
    folder.write("a.bag", maker.bag());
    return openBag(folder / "a.bag");
}

uint32_t colourOfClouds(const std::vector<ExtraField>& fields, const std::string& word) {
    const TemporaryFolder folder;
    const auto camera = cloudsWith(folder, fields, {word});
    return camera->info().hasColour ? (*camera->next())->colour[5] : 0;
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

TEST_CASE(
    "Clouds of bags may have their colour packed, in three values of one field, or in fields of their own") {
    constexpr uint32_t kExpected = 0xff140ac8u;
    const std::string levels = "\xc8\x0a\x14";
    CHECK(colourOfClouds({{"rgb", 0, 7}}, raw(uint32_t{0x00c80a14})) == kExpected);
    CHECK(colourOfClouds({{"rgba", 0, 6, 0}}, raw(uint32_t{0xffc80a14})) == kExpected); // a count of 0
    CHECK(colourOfClouds({{"rgb", 0, 2, 3}}, levels) == kExpected);
    CHECK(colourOfClouds({{"r", 0, 2}, {"g", 1, 2}, {"b", 2, 2}}, levels) == kExpected);
    CHECK(colourOfClouds({{"red", 0, 4}, {"green", 2, 4}, {"blue", 4, 4}},
                         raw(uint16_t{51400}) + raw(uint16_t{2570}) + raw(uint16_t{5140})) == kExpected);
    CHECK(colourOfClouds({{"r", 0, 7}, {"g", 4, 7}, {"b", 8, 7}}, raw(1.0f) + raw(0.0f) + raw(0.5f)) ==
          0xff8000ffu);
    CHECK(colourOfClouds({{"r", 0, 8}, {"g", 8, 8}, {"b", 16, 8}}, raw(200.0) + raw(10.0) + raw(20.0)) ==
          kExpected);
    CHECK(colourOfClouds({{"rgb", 1, 7}}, raw(uint32_t{0})) == 0);               // beyond the point
    CHECK(colourOfClouds({{"r", 0, 9}, {"g", 1, 9}, {"b", 2, 9}}, levels) == 0); // of no type
}

TEST_CASE("Points of float64 are played as those of float32") {
    Out out{stampedHeader(1.0, "camera")};
    out.put(uint32_t{7}).put(uint32_t{9}).put(uint32_t{3});
    for (uint32_t i = 0; i < 3; ++i) {
        out.text(std::string(1, static_cast<char>('x' + i))).put(8 * i).put(uint8_t{8}).put(uint32_t{1});
    }
    std::string points;
    for (uint32_t i = 0; i < 63; ++i) {
        const uint32_t down = i / 9;
        const double column = i % 9, row = down;
        points += raw((column - 4.0) / 10.0) + raw((row - 3.0) / 10.0) + raw(1.25);
    }
    out.put(uint8_t{0}).put(uint32_t{24}).put(uint32_t{9 * 24}).text(points).put(uint8_t{1});
    BagMaker maker;
    maker.add("/points", "sensor_msgs/PointCloud2", 1.0, out.bytes);
    const TemporaryFolder folder;
    folder.write("a.bag", maker.bag());
    const auto camera = openBag(folder / "a.bag");
    CHECK((*camera->next())->depth[20] * camera->info().metresPerUnit == doctest::Approx(1.25));
}

TEST_CASE("A dark cloud keeps the full scale of the clouds around it") {
    const TemporaryFolder folder;
    const auto words = [](uint16_t level) { return raw(level) + raw(level) + raw(level); };
    const auto camera =
        cloudsWith(folder, {{"r", 0, 4}, {"g", 2, 4}, {"b", 4, 4}}, {words(200), words(51400), words(100)});
    REQUIRE(camera->info().hasColour);
    for (const uint32_t level : {0x010101u, 0xc8c8c8u, 0x000000u}) {
        CHECK((*camera->next())->colour[5] == (0xff000000u | level));
    }
}

TEST_CASE("A cloud without colour that is read names its fields") {
    const TemporaryFolder folder;
    const auto camera = cloudsWith(folder, {{"rgb", 0, 8}, {"normal", 8, 7, 3}}, {std::string(20, '\0')});
    mentions(camera->whyNoColour(),
             "no colour is read from the fields x F4, y F4, z F4, rgb F8, normal F4 x 3 (read");
    folder.write(
        "a.pcd", "FIELDS x y z rgb\nSIZE 4 4 4 8\nTYPE F F F U\nCOUNT 1 1 1 1\nWIDTH 5\nHEIGHT 4\n"
                 "POINTS 20\nDATA ascii\n" +
                     [] {
                         std::string points;
                         for (int i = 0; i < 20; ++i) {
                             points +=
                                 std::to_string(i % 5 - 2) + " " + std::to_string(i / 5 - 2) + " 10 0\n";
                         }
                         return points;
                     }());
    mentions(PcdCamera(folder / "a.pcd").whyNoColour(), "from the fields x F4, y F4, z F4, rgb U8 (read");
    mentions(PcdCamera(folder / "a.pcd", {.colour = "none"}).whyNoColour(), "no colour is read");
}
