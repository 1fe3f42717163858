// SPDX-License-Identifier: Apache-2.0
// Recordings of an Azure Kinect: tests/devices/matroska_maker.h, and a file that libmatroska 1.7.1 wrote.
#include "devices/bag/kinect_calibration.h"
#include "engine/types/colour_copy.h"
#include "tests/devices/matroska_maker.h"
#include "tests/devices/played_bag.h"
#include "tests/support/mentions.h"
#include "tests/support/refusal.h"

#include <spdlog/spdlog.h>

using namespace fathom;
using namespace fathom::testing;

namespace {

constexpr uint32_t kAcrossDepth = 320, kDownDepth = 288, kAcrossColour = 32, kDownColour = 18;
constexpr uint64_t kFrame = 33'333; // [us]
constexpr size_t kDepthPixels = size_t{kAcrossDepth} * kDownDepth;

std::string plainDepth(uint16_t value) {
    std::string all;
    for (size_t i = 0; i < kDepthPixels; ++i) {
        all += {static_cast<char>(value >> 8), static_cast<char>(value)}; // big-endian
    }
    return all;
}

std::string plainBgra(uint8_t r, uint8_t g, uint8_t b) {
    std::string all;
    for (uint32_t i = 0; i < kAcrossColour * kDownColour; ++i) {
        all += {static_cast<char>(b), static_cast<char>(g), static_cast<char>(r), '\xff'};
    }
    return all;
}

// Frames of 0.5, 0.501, ... m, red with green 0, 1, ..., the colour 1 ms before its depth.
MkvFile recorded(uint32_t frames = 3, const KinectLenses& lenses = {}) {
    MkvFile file;
    file.tracks = {{1, "COLOR", kAcrossColour, kDownColour, "BGRA", 11, ""},
                   {2, "DEPTH", kAcrossDepth, kDownDepth, "b16g", 12, ""},
                   {3, "IR", kAcrossDepth, kDownDepth, "b16g", 13, ""}};
    file.tags = {{"K4A_DEPTH_TRACK", "12"}, {"K4A_DEPTH_MODE", "NFOV_2X2BINNED"}};
    file.calibration = kinectCalibration(lenses);
    for (uint32_t i = 0; i < frames; ++i) {
        file.blocks.push_back({1, i * kFrame, plainBgra(200, static_cast<uint8_t>(i), 10)});
        file.blocks.push_back({2, i * kFrame + 1000, plainDepth(static_cast<uint16_t>(500 + i))});
        file.blocks.push_back({3, i * kFrame + 1000, plainDepth(9)});
    }
    return file;
}

BagCamera playMkv(const TemporaryFolder& folder, const std::string& bytes,
                  const SourceOptions& options = {}) {
    folder.write("a.mkv", bytes);
    return BagCamera(folder.path() / "a.mkv", options);
}

std::string mkvRefusal(const TemporaryFolder& folder, const std::string& bytes) {
    return testing::refusalOf([&] { playMkv(folder, bytes); });
}

// Counts the frames. Each must be a recorded one, in order.
uint32_t soundFrames(BagCamera& camera) {
    uint32_t used = 0, last = 0;
    while (const auto frame = camera.next()) {
        const uint32_t depth = (*frame)->depth[kDepthPixels - 1];
        CHECK(depth >= 500 + last);
        CHECK(coloursOf(**frame).back() == (0xff0a00c8u | (depth - 500) << 8));
        last = depth - 500;
        ++used;
    }
    return used;
}

struct ScopedLogOff {
    ScopedLogOff() { spdlog::set_level(spdlog::level::off); }
    ~ScopedLogOff() { spdlog::set_level(spdlog::level::info); }
};

} // namespace

TEST_CASE("A recording of an Azure Kinect gives depth, colour, lenses and the pose between them") {
    const TemporaryFolder folder;
    // 90 degrees about z, row by row.
    MkvFile file = recorded(3, {.rotation = "[0,-1,0,1,0,0,0,0,1]"});
    file.tags.emplace_back("K4A_START_OFFSET_NS", "5000000000");
    BagCamera camera = playMkv(folder, file.bytes());
    CHECK(camera.info().metresPerUnit == 0.001);
    CHECK(camera.warnings().empty());
    CHECK_FALSE(camera.info().registered);
    CHECK(camera.info().depth.fx == 256.0);
    CHECK(camera.info().depth.cx == doctest::Approx(0.5 * 512 - 96 - 0.5));
    CHECK(camera.info().depth.cy == doctest::Approx(0.5 * 512 - 90 - 0.5));
    CHECK(camera.info().colour.fy == doctest::Approx(0.625 * 24));
    CHECK(camera.info().colour.cy == doctest::Approx(0.5 * 24 - 3 - 0.5));
    const dvec3 moved = camera.info().colourTdepth.apply({1.0, 2.0, 3.0});
    CHECK(moved.x == doctest::Approx(-2.032));
    CHECK(moved.y == doctest::Approx(0.998));
    CHECK(moved.z == doctest::Approx(3.004));
    CHECK(mentions(camera.streams(), "not used: IR (mono16)"));
    const auto frame = camera.next();
    REQUIRE(frame);
    CHECK((*frame)->captureTime == doctest::Approx(5.001));
    CHECK((*frame)->depth[0] == 500);
    CHECK(soundFrames(camera) == 2);
    CHECK(camera.skipped() == 0);
}

TEST_CASE("Depth and colour of an Azure Kinect are paired by their stamps and the recorded delay") {
    const TemporaryFolder folder;
    MkvFile file = recorded();
    for (MkvBlock& block : file.blocks) { // depth a whole frame late
        block.time += block.track == 1 ? 0 : kFrame;
    }
    file.tags.emplace_back("K4A_DEPTH_DELAY_NS", "33333000");
    BagCamera camera = playMkv(folder, file.bytes());
    CHECK(soundFrames(camera) == 3);
    file.tags.back().second = "soon";
    CHECK(mentions(mkvRefusal(folder, file.bytes()), "tag K4A_DEPTH_DELAY_NS: 'soon'"));
}

TEST_CASE("Every mode of an Azure Kinect has the lens of its part of the sensor") {
    const auto calibration = [](const KinectLenses& lenses) {
        const std::string text = kinectCalibration(lenses);
        return KinectCalibration({text.begin(), text.end()}, "c.json");
    };
    const KinectCalibration plain = calibration({});
    CHECK(plain.depth(640, 576).cx == doctest::Approx(319.5));
    CHECK(plain.depth(640, 576).cy == doctest::Approx(331.5));
    CHECK(plain.depth(512, 512).cx == doctest::Approx(255.5));
    CHECK(plain.depth(1024, 1024).fx == doctest::Approx(512.0));
    CHECK_THROWS_WITH_AS(plain.depth(640, 480), doctest::Contains("640x480, which no depth mode has"), Error);
    CHECK(plain.colour(1280, 720).cy == doctest::Approx(0.5 * 960 - 120 - 0.5));
    CHECK(plain.colour(2048, 1536).cy == doctest::Approx(767.5));
    CHECK(plain.colour(3840, 2160).fy == doctest::Approx(0.625 * 2880));
    CHECK_THROWS_WITH_AS(plain.colour(640, 576), doctest::Contains("no colour mode"), Error);
    // Early calibrations are of 16:9, the middle of 4:3.
    const KinectCalibration early = calibration({.colour = "[0.5,0.4,0.5,0.8,0,0,0,0,0,0,0,0,0,0]",
                                                 .colourSize = R"("SensorWidth":3840,"SensorHeight":2160)"});
    CHECK(early.colour(1920, 1080).cy == doctest::Approx(0.4 * 1080 - 0.5));
    CHECK(early.colour(1920, 1080).fy == doctest::Approx(0.8 * 1080));
}

TEST_CASE("A lens of an Azure Kinect projects as the SDK's formula does") {
    const TemporaryFolder folder;
    const KinectLenses bent{.depth =
                                "[0.51,0.49,0.49,0.48,0.2,0.05,0.004,0.5,0.1,0.02,0,0,0.0003,-0.0007,1.7]"};
    const Intrinsics lens = playMkv(folder, recorded(1, bent).bytes()).info().depth;
    const double x = 0.31, y = -0.22, r = x * x + y * y;
    const double radial =
        (1 + 0.2 * r + 0.05 * r * r + 0.004 * r * r * r) / (1 + 0.5 * r + 0.1 * r * r + 0.02 * r * r * r);
    const double p1 = -0.0007, p2 = 0.0003;
    const double u = x * radial + (r + 2 * x * x) * p2 + 2 * x * y * p1,
                 v = y * radial + (r + 2 * y * y) * p1 + 2 * x * y * p2;
    const glm::dvec2 pixel = lens.project({x, y, 1.0});
    CHECK(pixel.x == doctest::Approx(u * 0.49 * 512 + 0.51 * 512 - 96 - 0.5).epsilon(1e-9));
    CHECK(pixel.y == doctest::Approx(v * 0.48 * 512 + 0.49 * 512 - 90 - 0.5).epsilon(1e-9));
    for (const auto& [numbers, model] : {std::pair("[0.5,0.5,0.5,0.5,0,0,0,0,0,0,0.001,0,0,0]",
                                                   "CALIBRATION_LensDistortionModelBrownConrady"),
                                         std::pair("[0.5,0.5,0.5,0.5,0,0,0,0,0,0,0,0,0,0.001]",
                                                   "CALIBRATION_LensDistortionModelRational6KT")}) {
        const std::string fault = mkvRefusal(folder, recorded(1, {.depth = numbers, .model = model}).bytes());
        CHECK(mentions(fault, "DEPTH/camera_info: lens model"));
    }
}

TEST_CASE("Images of a Matroska track are read in every code of the recorder, and named where they are not") {
    const TemporaryFolder folder;
    MkvFile file = recorded(1);
    file.tracks[1].name = "other"; // the tag decides
    file.tracks[0].fourcc = "NV12";
    file.blocks[0].data = std::string(kAcrossColour * kDownColour, '\x51');
    for (uint32_t i = 0; i < kAcrossColour * kDownColour / 4; ++i) {
        file.blocks[0].data += "\x5a\xf0";
    }
    BagCamera planar = playMkv(folder, file.bytes());
    const auto frame = planar.next();
    REQUIRE(frame);
    CHECK((coloursOf(**frame)[0] & 0xff) > 244); // red
    file.tracks[0].fourcc = "YUY2";
    file.blocks[0].data.clear();
    for (uint32_t i = 0; i < kAcrossColour * kDownColour / 2; ++i) {
        file.blocks[0].data += "\x51\x5a\x51\xf0";
    }
    BagCamera packed = playMkv(folder, file.bytes());
    const auto other = packed.next();
    REQUIRE(other);
    CHECK(coloursOf(**other) == coloursOf(**frame)); // the same red
    file.tracks[0].fourcc = "H264";
    CHECK(mentions(playMkv(folder, file.bytes()).whyNoColour(), "COLOR (V_MS/VFW/FOURCC H264 Video)"));
    file.tracks[1].fourcc = "YUY2"; // early recordings, little-endian
    file.blocks[1].data = filled(uint16_t{700}, kDepthPixels);
    BagCamera early = playMkv(folder, file.bytes());
    CHECK(firstDepth(early) == doctest::Approx(0.7));
    file.tracks[1].more = ebml(0x6D80, "");
    CHECK(mentions(mkvRefusal(folder, file.bytes()), "topics: IR (mono16)"));
    file.tracks = {file.tracks[2]}; // infrared alone
    CHECK(mentions(mkvRefusal(folder, file.bytes()), "topics: IR (mono16)"));
}

TEST_CASE("A Matroska file without its calibration, size or tracks is refused in one line") {
    const TemporaryFolder folder;
    MkvFile file = recorded(1);
    file.calibration = "";
    CHECK(mentions(mkvRefusal(folder, file.bytes()), "DEPTH/camera_info: no attached calibration.json"));
    file.calibration = "{";
    CHECK(mentions(mkvRefusal(folder, file.bytes()), "calibration.json: content: not JSON"));
    file.calibration = R"({"CalibrationInformation":{"Cameras":[]}})";
    CHECK(mentions(mkvRefusal(folder, file.bytes()), "no camera at CALIBRATION_CameraLocationD0"));
    file = recorded(1, {.rotation = "[1,1,0,0,1,0,0,0,1]"});
    CHECK(mentions(mkvRefusal(folder, file.bytes()), "Rt.Rotation"));
    file = recorded(1);
    file.tracks[1].width = 319;
    CHECK(mentions(mkvRefusal(folder, file.bytes()), "DEPTH/camera_info: 319x288, which no depth mode has"));
    file.tracks.clear();
    CHECK(mentions(mkvRefusal(folder, file.bytes()), "no tracks"));
    CHECK(mentions(mkvRefusal(folder, recorded(0).bytes()),
                   "no images but COLOR (sensor_msgs/Image, no messages)"));
    CHECK(mentions(mkvRefusal(folder, "\x1a\x45\xdf\xa3"), "content: "));
    CHECK(mentions(mkvRefusal(folder, ""), "content: "));
}

TEST_CASE("Damage in a Matroska file loses the images of its cluster only, and is named") {
    const TemporaryFolder folder;
    const ScopedLogOff off;
    MkvFile file = recorded(4);
    const std::string whole = file.bytes();
    for (const bool sized : {true, false}) { // a recorder that was killed leaves sizes open
        file.sized = sized;
        BagCamera camera = playMkv(folder, file.bytes());
        CHECK(soundFrames(camera) == 4);
    }
    // The header of the cluster of the second depth image.
    const std::string cluster = recorded(4).cluster(4);
    const size_t at = whole.find(cluster);
    constexpr size_t kTime = 34; // another time is no damage that could be seen
    for (size_t byte = 0; byte < 52; byte += byte + 1 == kTime ? 9 : 1) {
        std::string damaged = whole;
        damaged[at + byte] = '\0';
        BagCamera camera = playMkv(folder, damaged);
        CHECK(soundFrames(camera) >= 2);
    }
    for (const size_t cut : {size_t{1}, cluster.size() - 9, cluster.size() + 1}) { // from the end
        BagCamera camera = playMkv(folder, whole.substr(0, whole.size() - cut));
        CHECK(soundFrames(camera) >= 3);
    }
    for (size_t size = 0; size < whole.find(recorded(4).cluster(0)); size += 7) {
        CHECK_FALSE(mkvRefusal(folder, whole.substr(0, size)).empty());
    }
}

TEST_CASE("A file that libmatroska wrote as k4arecorder does gives its images, with lenses of a file") {
    const TemporaryFolder folder;
    folder.write("lenses.json", R"({"depth": {"width": 5, "height": 3, "fx": 5, "fy": 5, "cx": 2, "cy": 1},
        "color": {"width": 16, "height": 9, "fx": 9, "fy": 9, "cx": 8, "cy": 4},
        "depth_scale_m_per_unit": 0.001,
        "extrinsics_topic_tf": {"Color": {"t": [-0.032, 0, 0], "q_xyzw": [0, 0, 0, 1]}}})");
    const std::filesystem::path file = "tests/fuzz/corpus/matroska/libmatroska";
    BagCamera camera(file, {.intrinsics = folder.path() / "lenses.json"});
    for (uint32_t i = 0; i < 2; ++i) {
        const auto frame = camera.next();
        REQUIRE(frame);
        CHECK((*frame)->captureTime == doctest::Approx(2.0 + 0.033333 * i + 0.0005));
        CHECK((*frame)->depth[14] == 500 + i);
        CHECK(coloursOf(**frame)[143] == (0xff0a00c8u | i << 8));
    }
    CHECK_FALSE(camera.next());
    CHECK_THROWS_WITH_AS(BagCamera{file}, doctest::Contains("5x3, which no depth mode has"), BadInput);
}

TEST_CASE("Sizes in a Matroska file that its bytes cannot hold are refused before memory is taken") {
    const TemporaryFolder folder;
    MkvFile file = recorded(1);
    const std::string whole = file.bytes();
    const std::string data = ebml(0x465C, file.calibration);
    std::string large = whole;
    large.replace(whole.find(data) + 2, 8, "\x01\x00\x00\x10\x00\x00\x00\x00", 8); // 64 GiB
    CHECK_FALSE(mkvRefusal(folder, large).empty());
    std::string nested; // 100,000 tags in each other
    for (uint32_t inner = 100'000; inner-- > 0;) {
        const uint32_t size = 10 * inner;
        nested += std::string("\x67\xc8\x01\0\0\0", 6) + static_cast<char>(size >> 24) +
                  static_cast<char>(size >> 16) + static_cast<char>(size >> 8) + static_cast<char>(size);
    }
    file.sized = false;
    std::string deep = file.bytes();
    deep.insert(deep.find(file.cluster(0)), ebml(0x1254C367, ebml(0x7373, nested)));
    CHECK(playMkv(folder, deep).next());
    file.tracks[1].width = 0xFFFFFFFF;
    CHECK(mentions(mkvRefusal(folder, file.bytes()), "IR (mono16) (allowed: one of depth"));
}
