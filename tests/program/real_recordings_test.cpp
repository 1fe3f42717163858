// SPDX-License-Identifier: Apache-2.0
// Replays the real recordings, which are stored outside the repository. No penetration, and classify marks
// exactly the pixels that a direct count finds, which agree to 2 % with those measured when the data was
// collected.
#include "tests/rig/stage.h"
#include "tests/support/sanitized.h"

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <sstream>

using namespace fathom;

namespace {

constexpr const char* kAnyDepth = "near: 0.001, far: 60"; // beyond the range of all these cameras

// Inclusive bands. The hue in degrees wraps around at 0.
struct Gates {
    double hueFrom, hueTo, saturationFrom, saturationTo, lightnessFrom, lightnessTo;

    std::string row(const std::string& name, const std::string& role) const {
        std::ostringstream text;
        text << "name: " << name << ", role: " << role << ", hue: [" << hueFrom << ", " << hueTo
             << "], saturation: [" << saturationFrom << ", " << saturationTo << "], lightness: ["
             << lightnessFrom << ", " << lightnessTo << "]";
        return text.str();
    }
    // Hexagonal HSL in float64: with byte colours no value is closer than 1e-9 to a bound without being equal
    // to it.
    bool take(uint32_t rgba) const {
        const double r = rgba & 255u, g = rgba >> 8 & 255u, b = rgba >> 16 & 255u;
        const double most = std::max({r, g, b}), least = std::min({r, g, b}), chroma = most - least;
        if (chroma == 0.0) {
            return false;
        }
        const double sixth = most == r   ? std::fmod((g - b) / chroma + 6.0, 6.0)
                             : most == g ? (b - r) / chroma + 2.0
                                         : (r - g) / chroma + 4.0;
        const double hue = 60.0 * sixth, lightness = (most + least) / 510.0;
        const double saturation = chroma / 255.0 / (1.0 - std::abs(2.0 * lightness - 1.0));
        const auto within = [](double x, double lo, double hi) { return x >= lo - 1e-9 && x <= hi + 1e-9; };
        const bool hueFits =
            hueFrom <= hueTo ? within(hue, hueFrom, hueTo) : hue >= hueFrom - 1e-9 || hue <= hueTo + 1e-9;
        return hueFits && within(saturation, saturationFrom, saturationTo) &&
               within(lightness, lightnessFrom, lightnessTo);
    }
};

constexpr Gates kWheel{345, 20, 0.45, 1, 0.05, 0.9}, kLever{110, 165, 0.25, 1, 0.05, 0.6},
    kDrill{335, 12, 0.55, 1, 0.12, 0.6}, kMustard{38, 60, 0.5, 1, 0.3, 0.85},
    kYellowThings{44, 64, 0.5, 1, 0.2, 0.8}, kCase{345, 14, 0.6, 1, 0.1, 0.7};

// Number of pixels with depth that the gates accept, one per frame of associations.txt.
std::vector<uint64_t> plainCount(const std::string& recording, const Gates& gates) {
    std::vector<uint64_t> counts;
    std::istringstream index(readWhole(kRecordings / recording / "associations.txt"));
    for (std::string colourStamp, colour, depthStamp, depth;
         index >> colourStamp >> colour >> depthStamp >> depth;) {
        const ReadImage image = readImage(kRecordings / recording / colour),
                        ranges = readImage(kRecordings / recording / depth);
        uint64_t count = 0;
        for (size_t i = 0; i < image.pixels.size(); ++i) {
            count += (ranges.pixels[i] & 0xffffffu) != 0 && gates.take(image.pixels[i]);
        }
        counts.push_back(count);
    }
    return counts;
}

void checkCounts(const Replay& replay, const std::vector<uint64_t>& counts, uint64_t FrameRow::*column) {
    REQUIRE(replay.frames.size() == counts.size());
    for (size_t i = 0; i < counts.size(); ++i) {
        CAPTURE(i);
        CHECK(replay.frames[i].*column == counts[i]);
    }
}

Replay run(const Stage& stage, const std::string& scene, const std::string& recording,
           const std::vector<std::string>& more = {}) {
    std::vector<std::string> words{
        "replay", scene, "--source", (kRecordings / recording).string(), "--out", (stage / "out").string()};
    words.insert(words.end(), more.begin(), more.end());
    const ProgramRun child = runFathom(words);
    CAPTURE(child.err);
    REQUIRE(child.exitCode == 0);
    CHECK(child.err == "");
    const Replay replay = readReplay(stage / "out", child);
    checkContract(replay, {1000.0, 20.0, 2.0, false});
    CHECK(replay.summary.at("frames").at("skipped") == 0);
    return replay;
}

// Counts the classes of a recording, with the hand at rest far behind the camera.
Replay count(const Stage& stage, const std::string& recording, const std::vector<std::string>& rows) {
    SceneText scene;
    scene.camera = kAnyDepth;
    scene.fixtures = rows;
    stage.scene(scene);
    stage.hand({{0.0, {0.0, 0.0, -2.0}}});
    return run(stage, (stage / "scene.yaml").string(), recording,
               {"--operator", (stage / "hand.csv").string()});
}

} // namespace

TEST_CASE(
    "valve_globe: the red wheel has the measured number of points in every frame, and the hand feels it") {
    if (!haveRecording("valve_globe_d435")) {
        return;
    }
    Stage stage;
    const Replay shipped = run(stage, "apps/scenes/valve_globe.yaml", "valve_globe_d435");
    CHECK(shipped.frames.size() == 60);
    CHECK(shipped.haptic().at("max_force_N").get<double>() > 5.0);
    const std::vector<uint64_t> counts = plainCount("valve_globe_d435", kWheel);
    checkCounts(count(stage, "valve_globe_d435", {kWheel.row("wheel", "forbidden")}), counts,
                &FrameRow::forbidden);
    CHECK(double(*std::min_element(counts.begin(), counts.end())) == doctest::Approx(498).epsilon(0.02));
    CHECK(double(*std::max_element(counts.begin(), counts.end())) == doctest::Approx(1331).epsilon(0.02));
}

TEST_CASE(
    "valve_ball: the green lever has the measured number of points in every frame, and the hand feels it") {
    if (!haveRecording("valve_ball_d435")) {
        return;
    }
    Stage stage;
    const Replay shipped = run(stage, "apps/scenes/valve_ball.yaml", "valve_ball_d435");
    CHECK(shipped.frames.size() == 27);
    CHECK(shipped.haptic().at("max_force_N").get<double>() > 5.0);
    const std::vector<uint64_t> counts = plainCount("valve_ball_d435", kLever);
    checkCounts(count(stage, "valve_ball_d435", {kLever.row("lever", "forbidden")}), counts,
                &FrameRow::forbidden);
    CHECK(double(*std::min_element(counts.begin(), counts.end())) == doctest::Approx(414).epsilon(0.02));
    CHECK(double(*std::max_element(counts.begin(), counts.end())) == doctest::Approx(1230).epsilon(0.02));
    CHECK(double(counts.at(12)) == doctest::Approx(1024).epsilon(0.02));
}

TEST_CASE("ycb: five stills have the measured numbers of points") {
    if (!haveRecording("ycb_posecnn_demo")) {
        return;
    }
    Stage stage;
    const Replay shipped = run(stage, "apps/scenes/ycb.yaml", "ycb_posecnn_demo");
    CHECK(shipped.frames.size() == 5);
    CHECK(shipped.haptic().at("max_force_N").get<double>() > 1.0); // guidance on unrelated stills
    CHECK(!shipped.summary.at("guidance").at(0).at("position_m").is_null());
    const Replay counted = count(stage, "ycb_posecnn_demo",
                                 {kDrill.row("red", "forbidden"), kMustard.row("yellow", "guidance")});
    const std::vector<uint64_t> red = plainCount("ycb_posecnn_demo", kDrill),
                                yellow = plainCount("ycb_posecnn_demo", kMustard);
    checkCounts(counted, red, &FrameRow::forbidden);
    checkCounts(counted, yellow, &FrameRow::guidance);
    CHECK(double(red.at(0)) == doctest::Approx(24928).epsilon(0.02));
    CHECK(double(yellow.at(0)) == doctest::Approx(15432).epsilon(0.02));
}

TEST_CASE("tum_fr1: yellow objects through a distorted lens have the measured number of points") {
    if (!haveRecording("tum_fr1_single")) {
        return;
    }
    Stage stage;
    const Replay counted =
        count(stage, "tum_fr1_single",
              {kYellowThings.row("yellow", "guidance"), kYellowThings.row("things", "forbidden")});
    const std::vector<uint64_t> counts = plainCount("tum_fr1_single", kYellowThings);
    checkCounts(counted, counts, &FrameRow::guidance);
    checkCounts(counted, counts, &FrameRow::forbidden);
    CHECK(double(counts.at(0)) == doctest::Approx(5936).epsilon(0.02));
    run(stage, (stage / "scene.yaml").string(), "tum_fr1_single"); // the path pushes into the regions
}

TEST_CASE("realsense_bag: unregistered depth finds its colour through the extrinsics") {
    if (!haveRecording("realsense_bag")) {
        return;
    }
    Stage stage;
    const Replay counted = count(stage, "realsense_bag", {kCase.row("case", "forbidden")});
    // 6278 pixels of the colour image, whose focal length is 1.57 times that of the depth image.
    MESSAGE("red case points: ", counted.frames.at(0).forbidden);
    CHECK(counted.frames.at(0).forbidden > 0.5 * 6278 / (1.57 * 1.57));
    CHECK(counted.frames.at(0).forbidden < 1.1 * 6278 / (1.57 * 1.57));
    CHECK(counted.frames.at(0).times.count("occlusion_ms") == 1);
    const Replay felt = run(stage, (stage / "scene.yaml").string(), "realsense_bag");
    CHECK(felt.haptic().at("max_force_N").get<double>() > 5.0);
}

TEST_CASE(
    "pcl_milk_table: everything within a metre is forbidden, with the same result of CPU and GPU query" *
    doctest::skip(kSanitized)) {
    if (!haveRecording("pcl_milk_table")) {
        return;
    }
    Stage stage;
    SceneText scene;
    scene.camera = "near: 0.3, far: 1.2";
    scene.fixtures = {"name: all, role: forbidden, radius: 0.02"};
    stage.scene(scene);
    const std::string file = (stage / "scene.yaml").string();
    const Replay cpu = run(stage, file, "pcl_milk_table", {"--query", "cpu"});
    const Replay gpu = run(stage, file, "pcl_milk_table", {"--query", "gpu"});
    CHECK(cpu.frames.at(0).forbidden == cpu.frames.at(0).valid);
    CHECK(cpu.frames.at(0).spheres > 10000);
    CHECK(cpu.haptic().at("max_force_N").get<double>() > 5.0);
    CHECK(cpu.summary.at("digest") == gpu.summary.at("digest"));
}
