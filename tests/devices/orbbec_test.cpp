// SPDX-License-Identifier: Apache-2.0
// Recordings of the Orbbec SDK, made by the serialisers of its messages (OrbbecSDK_v2, 3rdparty/rosbag).
#include "engine/types/colour_copy.h"
#include "tests/devices/played_bag.h"
#include "tests/support/mentions.h"

using namespace fathom;
using namespace fathom::testing;

namespace {

constexpr uint32_t kColumns = 7, kRows = 5;
constexpr const char* kDepthTopic = "/cam/sensor_3/frameType_3";
constexpr const char* kColourTopic = "/cam/sensor_2/frameType_2";

// custom_msg/OBStreamProfileInfo.
struct StreamProfile {
    std::array<float, 9> rotation{}; // row by row
    std::array<float, 3> translation{};
    uint16_t width = kColumns, height = kRows;
    std::array<float, 4> lens{6.0f, 6.5f, 3.25f, 2.25f};
    std::array<float, 8> distortion{}; // k1 to k6, p1, p2
    uint8_t model = 3;
};

std::string profileMessage(uint8_t stream, const StreamProfile& profile) {
    Out out{stampedHeader(1.0, "")};
    out.put(stream).put(uint8_t{8}).put(profile.rotation).put(profile.translation);
    out.put(profile.width).put(profile.height).put(uint16_t{30});
    return out.put(profile.lens).put(profile.distortion).put(profile.model).bytes;
}

void addProfile(BagMaker& maker, uint8_t stream, const StreamProfile& profile) {
    maker.add("/cam/streamProfileType_" + std::to_string(stream), "custom_msg/OBStreamProfileInfo", 1.0,
              profileMessage(stream, profile));
}

// Behind the data: depth units, number, three times, metadata and its size, bits per pixel.
std::string sdkImage(double t, const std::string& encoding, const std::string& pixels) {
    const ImageMessage image{
        .frame = "", .encoding = encoding, .width = kColumns, .height = kRows, .pixels = pixels};
    Out out{imageMessage(t, image)};
    out.put(0.0f).put(uint64_t{1}).put(uint64_t{2}).put(uint64_t{3}).put(uint64_t{4});
    return out.text("metadata").put(uint32_t{8}).put(uint8_t{16}).bytes;
}

void addImages(BagMaker& maker, const std::string& topic, const std::string& encoding,
               const std::string& pixels) {
    for (const double t : {1.0, 1.1, 1.2}) {
        maker.add(topic, "sensor_msgs/Image", t, sdkImage(t, encoding, pixels));
    }
}

template <class T>
void addProperty(BagMaker& maker, uint32_t id, T value) {
    const std::string bytes = raw(value);
    maker.add("/cam/property", "custom_msg/OBProperty", 1.0,
              stampedHeader(1.0, "") +
                  Out().put(id).text(bytes).put(static_cast<uint32_t>(bytes.size())).bytes);
}

BagMaker depthOnly(const StreamProfile& profile = {}, const std::string& encoding = "mono16") {
    BagMaker maker;
    addProfile(maker, 3, profile);
    addImages(maker, kDepthTopic, encoding, filled(uint16_t{500}, kColumns * kRows));
    return maker;
}

void addRed(BagMaker& maker) {
    addImages(maker, kColourTopic, "rgb8", filledColour(200, 10, 10, kColumns * kRows));
}

} // namespace

TEST_CASE("Depth and colour of an Orbbec recording are paired, with their lenses and the pose between them") {
    const TemporaryFolder folder;
    // 90 degrees about z, row by row; 10, -2 and 3 mm.
    BagMaker maker = depthOnly({.rotation = {0, -1, 0, 1, 0, 0, 0, 0, 1}, .translation = {10, -2, 3}});
    addProperty(maker, 75, int32_t{0});
    addProfile(maker, 2, {.lens = {5.0f, 5.5f, 3.0f, 2.0f}});
    addRed(maker);
    addProfile(maker, 1, {});
    addImages(maker, "/cam/sensor_1/frameType_1", "mono16",
              filled(uint16_t{9}, kColumns * kRows)); // infrared
    maker.add("/cam/streamProfileType_4", "custom_msg/OBImuStreamProfileInfo", 1.0, std::string(9, '\1'));
    BagCamera camera = playStreams(folder, maker);
    CHECK_FALSE(camera.info().registered);
    CHECK(camera.info().depth.fy == 6.5);
    CHECK(camera.info().depth.cx == 3.25);
    CHECK(camera.info().colour.fx == 5.0);
    const dvec3 moved = camera.info().colourTdepth.apply({1.0, 2.0, 3.0});
    CHECK(moved.x == doctest::Approx(-2.0 + 0.01));
    CHECK(moved.y == doctest::Approx(1.0 - 0.002));
    CHECK(moved.z == doctest::Approx(3.003));
    CHECK(mentions(camera.streams(), std::string("not used: /cam/sensor_1/frameType_1 (mono16)")));
    CHECK(camera.warnings().empty());
    for (int i = 0; i < 3; ++i) {
        const auto frame = camera.next();
        REQUIRE(frame);
        CHECK((*frame)->depth[34] == 500);
        CHECK(coloursOf(**frame)[34] == kRedPixel);
    }
    CHECK(camera.info().metresPerUnit == 0.001);
    CHECK_FALSE(camera.next());
}

TEST_CASE("The depth unit of an Orbbec recording is that of its precision level or its unit in millimetres") {
    const TemporaryFolder folder;
    const std::array<double, 7> millimetres{1.0, 0.8, 0.4, 0.1, 0.2, 0.5, 0.05};
    for (int32_t level = 0; level < 7; ++level) {
        BagMaker maker = depthOnly();
        addProperty(maker, 75, int32_t{3}); // the last one counts
        addProperty(maker, 75, level);
        CHECK(playStreams(folder, maker).info().metresPerUnit ==
              doctest::Approx(1e-3 * millimetres[static_cast<size_t>(level)]).epsilon(1e-9));
    }
    BagMaker flexible = depthOnly();
    addProperty(flexible, 176, 0.25f);
    CHECK(playStreams(folder, flexible).info().metresPerUnit == doctest::Approx(0.00025).epsilon(1e-9));
    BagMaker odd = depthOnly();
    addProperty(odd, 75, int32_t{7});
    CHECK(mentions(streamRefusal(folder, odd), "/cam/property: 75 (precision level) is 7 (allowed: 0 to 6)"));
    BagCamera camera = playStreams(folder, depthOnly());
    CHECK(camera.info().metresPerUnit == 0.001);
    REQUIRE(camera.warnings().size() == 1);
    CHECK(
        mentions(camera.warnings()[0], "no depth unit in /cam/property (75 or 176): depth is read as mill"));
    CHECK(playStreams(folder, depthOnly(), {.scale = 0.002}).warnings().empty());
}

TEST_CASE("The lens models of an Orbbec recording are those of its numbers") {
    const TemporaryFolder folder;
    const std::array<float, 8> k{0.01f, 0.02f, 0.03f, 0.04f, 0.05f, 0.06f, 0.007f, 0.008f};
    const auto lens = [&](uint8_t model) {
        return playStreams(folder, depthOnly({.distortion = k, .model = model})).info().depth;
    };
    CHECK(lens(0).pinhole());
    for (const uint8_t model : {uint8_t{1}, uint8_t{2}, uint8_t{3}, uint8_t{4}}) {
        const Intrinsics brown = lens(model);
        CHECK(brown.model == (model < 3 ? LensModel::ScaledTangential : LensModel::Polynomial));
        for (const auto& [place, value] : {std::pair(0, 0.01), std::pair(1, 0.02), std::pair(2, 0.007),
                                           std::pair(3, 0.008), std::pair(4, 0.03)}) {
            CHECK(brown.distortion[static_cast<size_t>(place)] == doctest::Approx(value));
        }
        CHECK(brown.divisor[2] == doctest::Approx(model == 4 ? 0.06 : 0.0));
    }
    CHECK(lens(5).model == LensModel::Equidistant);
    CHECK(lens(5).distortion[3] == doctest::Approx(0.04));
    CHECK(mentions(streamRefusal(folder, depthOnly({.distortion = k, .model = 6})),
                   "/cam/streamProfileType_3: distortion model 6"));
    CHECK(mentions(streamRefusal(folder, depthOnly({.width = 8})), "8x5 where the images"));
}

TEST_CASE("Disparity, and depth that the camera aligned to an unknown lens, are refused") {
    const TemporaryFolder folder;
    BagMaker disparity = depthOnly();
    addProperty(disparity, 85, false);
    CHECK(mentions(streamRefusal(folder, disparity), "/cam/property: 85 "));
    BagMaker onHost = depthOnly();
    addProperty(onHost, 3004, true);
    CHECK(mentions(streamRefusal(folder, onHost), "/cam/property: 3004 "));
    addProperty(onHost, 85, true);
    CHECK(streamRefusal(folder, onHost).empty());
    for (const bool same : {false, true}) {
        BagMaker aligned = depthOnly({.rotation = {1, 0, 0, 0, 1, 0, 0, 0, 1}, .translation = {20, 0, 0}});
        addProperty(aligned, 42, true);
        addProfile(aligned, 2, {.lens = {same ? 6.0f : 5.0f, 6.5f, 3.25f, 2.25f}});
        addRed(aligned);
        if (same) {
            CHECK(playStreams(folder, aligned).info().registered);
        } else {
            CHECK(mentions(streamRefusal(folder, aligned), "/cam/property: 42 "));
        }
    }
    BagMaker turned = depthOnly({.rotation = {1, 0, 0, 0, 1, 0, 0, 0, 1}});
    addProfile(turned, 2, {});
    addRed(turned);
    CHECK(playStreams(folder, turned).info().registered); // the same lens at the same place
}

TEST_CASE("The pose of an Orbbec recording is that of its colour camera, not of a stereo pair of colour") {
    const TemporaryFolder folder;
    BagMaker pair = depthOnly({.rotation = {1, 0, 0, 0, 1, 0, 0, 0, 1}, .translation = {20, 0, 0}});
    addProfile(pair, 11, {.lens = {5.0f, 5.5f, 3.0f, 2.0f}});
    addImages(pair, "/cam/sensor_11/frameType_13", "rgb8", filledColour(1, 2, 3, kColumns * kRows));
    CHECK(mentions(streamRefusal(folder, pair), "extrinsics: missing"));
    addProfile(pair, 2, {.lens = {4.0f, 4.5f, 3.0f, 2.0f}});
    addRed(pair);
    BagCamera camera = playStreams(folder, pair);
    CHECK(camera.info().colour.fx == 4.0);
    CHECK(camera.info().colourTdepth.position.x == doctest::Approx(0.02));
    const auto frame = camera.next();
    REQUIRE(frame);
    CHECK(coloursOf(**frame)[0] == kRedPixel);
}

TEST_CASE("Every encoding of depth of the Orbbec SDK is read, or named where it is not") {
    const TemporaryFolder folder;
    for (const char* encoding : {"mono16", "z16"}) {
        BagCamera camera = playStreams(folder, depthOnly({}, encoding));
        CHECK(firstDepth(camera) == doctest::Approx(0.5));
    }
    CHECK(mentions(streamRefusal(folder, depthOnly({}, "rle")), "/cam/sensor_3/frameType_3 (rle)"));
    BagMaker infrared;
    addProfile(infrared, 1, {});
    addImages(infrared, "/cam/sensor_1/frameType_1", "z16", filled(uint16_t{9}, kColumns * kRows));
    CHECK(mentions(streamRefusal(folder, infrared), "/cam/sensor_1/frameType_1 (z16)"));
    BagCamera damaged = playStreams(folder, depthOnly({}, "rvl")); // 500 everywhere is no RVL
    CHECK_THROWS_WITH_AS(damaged.next(), doctest::Contains("RVL: damaged"), BadInput);
    CHECK(damaged.skipped() == 3);
}

TEST_CASE("An Orbbec recording without colour's pose, images or whole messages is refused or named") {
    const TemporaryFolder folder;
    BagMaker poseless = depthOnly();
    addProfile(poseless, 2, {.lens = {5.0f, 5.5f, 3.0f, 2.0f}});
    addRed(poseless);
    CHECK(mentions(streamRefusal(folder, poseless), "extrinsics: missing"));
    CHECK_FALSE(playStreams(folder, poseless, {.colour = "none"}).info().hasColour);
    BagMaker sheared = depthOnly({.rotation = {1, 1, 0, 0, 1, 0, 0, 0, 1}}); // no rotation
    CHECK(mentions(streamRefusal(folder, sheared), "/cam/streamProfileType_3: an invalid transform"));
    BagMaker empty;
    addProfile(empty, 3, {});
    CHECK(mentions(streamRefusal(folder, empty), "no images but /cam/streamProfileType_3"));
    BagMaker cut;
    addProfile(cut, 3, {});
    cut.add("/cam/property", "custom_msg/OBProperty", 1.0, stampedHeader(1.0, "") + raw(uint32_t{75}));
    for (const double t : {1.0, 1.1}) {
        const std::string whole = sdkImage(t, "mono16", filled(uint16_t{500}, kColumns * kRows));
        cut.add(kDepthTopic, "sensor_msgs/Image", t, t > 1.0 ? whole.substr(0, 90) : whole);
    }
    BagCamera camera = playStreams(folder, cut);
    CHECK(camera.next());
    CHECK_FALSE(camera.next());
    CHECK(camera.skipped() == 1);
    const std::string profile = profileMessage(3, {});
    for (size_t size = 0; size < profile.size(); ++size) {
        BagMaker cutProfile;
        cutProfile.add("/cam/streamProfileType_3", "custom_msg/OBStreamProfileInfo", 1.0,
                       profile.substr(0, size));
        addImages(cutProfile, kDepthTopic, "mono16", filled(uint16_t{500}, kColumns * kRows));
        CHECK(mentions(streamRefusal(folder, cutProfile), "/cam/streamProfileType_3: truncated"));
    }
}
