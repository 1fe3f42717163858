// SPDX-License-Identifier: Apache-2.0
// Databases of the RealSense SDK, with texts as its writer makes them (librealsense, src/media/ros2).
#include "engine/types/colour_copy.h"
#include "tests/devices/database_maker.h"
#include "tests/devices/played_bag.h"
#include "tests/support/mentions.h"
#include "tests/support/refusal.h"

#include <limits>

using namespace fathom;
using namespace fathom::testing;

namespace {

constexpr uint32_t kWide = 7, kHigh = 5;
constexpr int64_t kAlways = std::numeric_limits<int64_t>::min(), kTick = 100'000'000; // [ns]
constexpr const char* kTexts = "std_msgs/msg/String";
const std::string kDepthStream = "/device_0/sensor_0/Depth_0", kColourStream = "/device_0/sensor_1/Color_0";

using Messages = std::vector<DatabaseMessage>;

std::string lensWords(const std::string& fx, const std::string& model = "None",
                      const std::string& coefficients = "0.000000,0.000000,0.000000,0.000000,0.000000") {
    return "width=7;height=5;fx=" + fx + ";ppx=3.25;fy=6.5;ppy=2.25;model=" + model +
           ";coeffs=" + coefficients;
}

void addText(Messages& all, const std::string& topic, const std::string& text, int64_t time = kAlways) {
    all.push_back({topic, kTexts, time, textCdr(text)});
}

void addImage(Messages& all, const std::string& stream, int64_t time, const std::string& encoding,
              const std::string& pixels) {
    const auto step = static_cast<uint32_t>(pixels.size() / kHigh);
    all.push_back({stream + "/image/data", "sensor_msgs/msg/Image", time,
                   imageCdr(time, {"Depth", encoding, kWide, kHigh, step, pixels})});
}

// Three pairs of 0.3 m, by units of 0.1 mm, with an infrared stream.
Messages sdkMessages(const std::string& lens = lensWords("6.25")) {
    Messages all;
    addText(all, "/device_0/info", "Name=RealSense D405;Serial Number=1");
    addText(all, "/device_0/sensor_0/option/Depth_Units/value", "0.000100");
    addText(all, kDepthStream + "/info", "encoding=Z16;fps=30");
    addText(all, kDepthStream + "/camera_info", lens);
    addText(all, kColourStream + "/camera_info", lensWords("5.5"));
    for (int64_t i = 1; i <= 3; ++i) {
        addImage(all, kDepthStream, i * kTick, "mono16", filled(uint16_t{3000}, kWide * kHigh));
        addText(all, kDepthStream + "/image/metadata", "Frame number=1;depth_units=0.000100;", i * kTick);
        addImage(all, kColourStream, i * kTick, "rgb8", filledColour(200, 10, 10, kWide * kHigh));
        addImage(all, "/device_0/sensor_0/Infrared_1", i * kTick, "8UC1", std::string(kWide * kHigh, 'i'));
    }
    addText(all, kDepthStream + "/tf/ref_0", "rotation=1,0,0,0,1,0,0,0,1;translation=0,0,0");
    // 90 degrees about z, column by column.
    addText(all, kColourStream + "/tf/ref_0",
            "rotation=0.000000,1.000000,0,-1,0,0,0,0,1;translation=0.010000,-0.002000,0.003000");
    return all;
}

Messages without(Messages all, const std::string& part) {
    std::erase_if(all, [&](const DatabaseMessage& one) { return one.topic.find(part) != std::string::npos; });
    return all;
}

BagCamera playDatabase(const TemporaryFolder& folder, const Messages& messages) {
    writeDatabase(folder.path() / "a.db3", messages);
    return BagCamera(folder.path() / "a.db3");
}

std::string databaseRefusal(const TemporaryFolder& folder, const Messages& messages) {
    return testing::refusalOf([&] { playDatabase(folder, messages); });
}

void checkPairs(BagCamera& camera) {
    for (int i = 1; i <= 3; ++i) {
        const auto frame = camera.next();
        REQUIRE(frame);
        CHECK((*frame)->captureTime == doctest::Approx(0.1 * i));
        CHECK((*frame)->depth[34] == 3000);
        CHECK(coloursOf(**frame)[34] == kRedPixel);
    }
    CHECK_FALSE(camera.next());
}

} // namespace

TEST_CASE("A database of the RealSense SDK gives depth and colour with its units, lenses and poses") {
    const TemporaryFolder folder;
    BagCamera camera = playDatabase(folder, sdkMessages());
    CHECK(camera.info().metresPerUnit == doctest::Approx(0.0001).epsilon(1e-12));
    CHECK(camera.info().depth.fx == 6.25);
    CHECK(camera.info().depth.cy == 2.25);
    CHECK(camera.info().colour.fx == 5.5);
    CHECK_FALSE(camera.info().registered);
    const dvec3 moved = camera.info().colourTdepth.apply({1.0, 2.0, 3.0});
    CHECK(moved.x == doctest::Approx(-2.0 + 0.01));
    CHECK(moved.y == doctest::Approx(1.0 - 0.002));
    CHECK(moved.z == doctest::Approx(3.003));
    CHECK(camera.warnings().empty());
    CHECK(mentions(camera.streams(), "not used: /device_0/sensor_0/Infrared_1/image/data (8UC1)"));
    checkPairs(camera);
}

TEST_CASE("Messages of a database that are compressed one by one give the same frames") {
    const TemporaryFolder folder;
    Messages all = packedOneByOne(sdkMessages());
    BagCamera camera = playDatabase(folder, all);
    CHECK(camera.info().metresPerUnit == doctest::Approx(0.0001).epsilon(1e-12));
    checkPairs(camera);
    // A frame that declares 2^40 bytes: refused before memory is taken.
    const std::string bomb("\x28\xb5\x2f\xfd\xc0\0\0\0\0\0\1\0\0\1\0\0", 16);
    for (DatabaseMessage& message : all) {
        message.bytes = message.topic == kDepthStream + "/camera_info" ? bomb : message.bytes;
    }
    CHECK(mentions(databaseRefusal(folder, all), "camera_info: zstd: no size"));
}

TEST_CASE("Without the option, the depth unit is that of the first image's metadata, otherwise a warning is "
          "logged") {
    const TemporaryFolder folder;
    const Messages bare = without(sdkMessages(), "Depth_Units");
    CHECK(playDatabase(folder, bare).info().metresPerUnit == doctest::Approx(0.0001).epsilon(1e-12));
    const BagCamera unknown = playDatabase(folder, without(bare, "metadata"));
    CHECK(unknown.info().metresPerUnit == 0.001);
    REQUIRE(unknown.warnings().size() == 1);
    CHECK(mentions(unknown.warnings()[0], "no option Depth_Units"));
    Messages changed = sdkMessages();
    addText(changed, "/device_0/sensor_0/option/Depth_Units/value", "0.001000", 5 * kTick / 2);
    BagCamera camera = playDatabase(folder, changed);
    CHECK(camera.next());
    CHECK(camera.next());
    CHECK_FALSE(camera.next()); // its unit is another
    CHECK(camera.skipped() == 1);
}

TEST_CASE("Every lens model of the RealSense SDK is read by its name") {
    const TemporaryFolder folder;
    const std::string k = "0.01,0.02,0.003,0.004,0.05";
    const auto lens = [&](const std::string& model) {
        return playDatabase(folder, sdkMessages(lensWords("6.25", model, k))).info().depth;
    };
    CHECK(lens("Brown Conrady").model == LensModel::Polynomial);
    CHECK(lens("Inverse Brown Conrady").model == LensModel::ScaledTangential);
    CHECK(lens("Modified Brown Conrady").distortion[4] == doctest::Approx(0.05));
    const std::string four = "0.01,0.02,0.003,0.004,0";
    CHECK(playDatabase(folder, sdkMessages(lensWords("6.25", "Kannala Brandt4", four))).info().depth.model ==
          LensModel::Equidistant);
    CHECK(mentions(databaseRefusal(folder, sdkMessages(lensWords("6.25", "Ftheta", k))),
                   "camera_info: model: Ftheta"));
}

TEST_CASE("A damaged text of a RealSense database is named, and never read as another value") {
    const TemporaryFolder folder;
    const std::string size = "width=7;height=5;", rest = ";ppx=3;fy=6;ppy=2;model=None;coeffs=0,0,0,0",
                      whole = rest + ",0";
    for (const auto& [lens, fault] :
         {std::pair(std::string(), "width: missing"), std::pair(std::string("width=7"), "height: missing"),
          std::pair(size + "fx=" + whole, "fx: ''"), std::pair(size + "fx=6,25" + whole, "fx: '6,25'"),
          std::pair(size + "fx=6" + rest, "coeffs: 4 numbers"),
          std::pair("width=7.5;height=5;fx=6" + whole, "width: 7.5"),
          std::pair(size + "fx=nan" + whole, "fx: 'nan'")}) {
        CHECK(mentions(databaseRefusal(folder, sdkMessages(lens)), std::string("camera_info: ") + fault));
    }
    CHECK(mentions(databaseRefusal(folder, without(sdkMessages(), "/tf/")), "extrinsics: missing"));
    Messages sheared = without(sdkMessages(), "Color_0/tf/");
    addText(sheared, kColourStream + "/tf/ref_0", "rotation=1,1,0,0,1,0,0,0,1;translation=0,0,0");
    CHECK(mentions(databaseRefusal(folder, sheared), "extrinsics: missing"));
    Messages far = without(sdkMessages(), "Color_0/tf/");
    addText(far, kColourStream + "/tf/ref_0", "rotation=1,0,0,0,1,0,0,0,1;translation=15,0,0");
    CHECK(mentions(databaseRefusal(folder, far), kColourStream + "/tf/ref_0: 15 m between the lenses"));
    CHECK(mentions(databaseRefusal(folder, without(sdkMessages(), "/image/data")), "no images but"));
}

TEST_CASE("The suffix of a compressed transport does not change where a RealSense stream has lens and unit") {
    for (const char* suffix : {"", "/compressed", "/compressedDepth"}) {
        const std::string topic = kDepthStream + "/image/data" + suffix;
        CHECK(optionsPrefix(topic) == "/device_0/sensor_0/option/");
        CHECK(lensTopics(topic).back() == kDepthStream + "/camera_info");
        CHECK(namedRole(topic) == NamedRole::Depth);
    }
}
