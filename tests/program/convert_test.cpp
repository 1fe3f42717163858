// SPDX-License-Identifier: Apache-2.0
// `fathom convert`: what it writes replays as its source does.
#include "devices/bag/bag_camera.h"
#include "devices/recorded/recorded_camera.h"
#include "engine/types/colour_copy.h"
#include "tests/rig/program_refusal.h"

#include <doctest/doctest.h>

using namespace fathom;

namespace {

std::vector<Image> movingWall() {
    std::vector<Image> images;
    for (uint16_t i = 0; i < 3; ++i) {
        images.push_back(bumpImage());
        images.back().set({2, 2, 10, 10}, static_cast<uint16_t>(550 + 10 * i));
    }
    return images;
}

void convertStage(const Stage& stage, const std::string& out, const std::vector<std::string>& more = {}) {
    std::vector<std::string> command{"convert", (stage / "rec").string(), "--out", (stage / out).string()};
    command.insert(command.end(), more.begin(), more.end());
    const ProgramRun run = runFathom(command);
    CHECK_MESSAGE(run.exitCode == 0, run.err);
    CHECK(run.err == "");
    CHECK(run.out.find("converted    3 frames, 0 skipped") != std::string::npos);
}

std::string digestOf(const Stage& stage, const std::string& source, const std::string& out) {
    const ProgramRun run = runFathom({"replay", (stage / "scene.yaml").string(), "--source",
                                      (stage / source).string(), "--operator", (stage / "hand.csv").string(),
                                      "--device", "llvmpipe", "--out", (stage / out).string()});
    CHECK_MESSAGE(run.exitCode == 0, run.err);
    return readReplay(stage / out, run).summary.at("digest");
}

// Both cameras give the same frames: depth in metres, colour, stamps.
void checkAlike(Camera& a, Camera& b) {
    uint32_t frames = 0;
    for (auto one = a.next(); one; one = a.next()) {
        const auto other = b.next();
        REQUIRE(other);
        CHECK(coloursOf(**one) == coloursOf(**other));
        CHECK((*one)->captureTime == doctest::Approx((*other)->captureTime));
        size_t apart = 0;
        for (size_t i = 0; i < (*one)->depth.size(); ++i) {
            const double off =
                (*one)->depth[i] * a.info().metresPerUnit - (*other)->depth[i] * b.info().metresPerUnit;
            apart += std::abs(off) > 1e-9 ? 1 : 0;
        }
        CHECK(apart == 0);
        ++frames;
    }
    CHECK(frames == 3);
    CHECK_FALSE(b.next());
}

} // namespace

TEST_CASE("A recording that is converted to a TUM folder and to MCAP replays with the digest of its source") {
    const Stage stage;
    stage.recording(movingWall());
    stage.write("rec/poses.txt", "0 0.1 0 0.2 0 0 0.1 1\n0.1 0.2 0 0.2 0 0 0.2 1\n");
    stage.scene({});
    stage.hand({{0.0, {0.0, 0.0, 0.3}}, {0.1, {0.0, 0.0, 0.6}}});
    convertStage(stage, "tum");
    for (const char* name :
         {"rgb.txt", "depth.txt", "associations.txt", "groundtruth.txt", "intrinsics.json"}) {
        CHECK(std::filesystem::exists(stage / "tum" / name));
    }
    CHECK(digestOf(stage, "tum", "out_tum") == digestOf(stage, "rec", "out_rec"));
    std::filesystem::remove(stage / "rec/poses.txt"); // MCAP is played without poses
    convertStage(stage, "mcap", {"--format", "mcap"});
    CHECK(digestOf(stage, "mcap/recording.mcap", "out_mcap") == digestOf(stage, "rec", "out_still"));
}

TEST_CASE(
    "A run that starts late in a recording begins with its first frame, and not at the recording's start") {
    const Stage stage;
    stage.recording(movingWall());
    stage.scene({});
    stage.hand({{0.0, {0.0, 0.0, 0.3}}, {0.1, {0.0, 0.0, 0.6}}});
    convertStage(stage, "mcap", {"--format", "mcap"});
    const auto firstSet = [&](const std::string& options) {
        const ProgramRun run = runFathom({"replay", (stage / "scene.yaml").string(), "--source",
                                          (stage / "mcap/recording.mcap").string() + options, "--operator",
                                          (stage / "hand.csv").string(), "--device", "llvmpipe", "--out",
                                          (stage / ("out" + options)).string()});
        CHECK_MESSAGE(run.exitCode == 0, run.err);
        const Replay replay = readReplay(stage / ("out" + options), run);
        const auto tick = std::find_if(replay.ticks.begin(), replay.ticks.end(),
                                       [](const auto& row) { return row.frame >= 0; });
        REQUIRE(tick != replay.ticks.end());
        return std::pair(tick - replay.ticks.begin(), tick->frame);
    };
    const auto whole = firstSet(""), late = firstSet(",start=0.001");
    CHECK(whole.second == 0);
    CHECK(late.second == 1);
    CHECK(late.first == whole.first);
}

TEST_CASE("MCAP of a folder keeps unregistered lenses, another depth unit and frames without colour") {
    const Stage stage;
    stage.recording(movingWall());
    const std::string lens = R"({"width": 64, "height": 48, "fx": 60, "fy": 61, "cx": 31.5, "cy": 23.5)";
    stage.write("rec/intrinsics.json",
                R"({"depth": )" + lens + R"(}, "color": )" + lens +
                    R"(, "distortion_model": "plumb_bob", "distortion": [0.01, 0.002, 0.001, -0.001]},
                    "depth_scale_m_per_unit": 0.0005, "extrinsics_topic_tf":
                    {"Color": {"t": [0.015, 0, 0], "q_xyzw": [0, 0.01, 0, 1]}}})");
    convertStage(stage, "mcap", {"--format", "mcap"});
    RecordedCamera source(stage / "rec");
    BagCamera result(stage / "mcap/recording.mcap");
    CHECK_FALSE(result.info().registered);
    CHECK(result.info().colour.distortion == source.info().colour.distortion);
    CHECK(glm::length(result.info().colourTdepth.position - source.info().colourTdepth.position) < 1e-12);
    CHECK(std::abs(result.info().colourTdepth.rotation.y - source.info().colourTdepth.rotation.y) < 1e-12);
    checkAlike(source, result);
}

TEST_CASE("MCAP holds wrench, poses and regions of a replay, between the frames that it played") {
    const Stage stage;
    stage.recording(movingWall());
    stage.scene({});
    stage.hand({{0.0, {0.0, 0.0, 0.3}}, {0.1, {0.0, 0.0, 0.6}}});
    const Replay replay = stage.replay({"--save-fixtures"});
    convertStage(stage, "mcap", {"--format", "mcap", "--replay", (stage / "out").string()});
    const auto file = openMessageFile(stage / "mcap/recording.mcap");
    for (const char* topic : {"/fathom/wrench", "/fathom/tool_pose", "/fathom/device_pose"}) {
        const MessageTopic* found = file->find(topic);
        REQUIRE(found != nullptr);
        CHECK(found->messages.size() == replay.ticks.size());
    }
    const MessageTopic* regions = file->find("/fathom/regions");
    REQUIRE(regions != nullptr);
    CHECK(regions->type == "sensor_msgs/PointCloud2");
    CHECK(regions->messages.size() == replay.frames.size());
    CHECK(regions->messages.back().time == file->find("/camera/color/image_raw")->messages.back().time);
}

TEST_CASE("convert rejects a replay of frames that its source does not have, and warns of one of fewer") {
    const Stage stage;
    stage.recording(movingWall());
    stage.scene({});
    stage.hand({{0.0, {0.0, 0.0, 0.3}}, {0.1, {0.0, 0.0, 0.6}}});
    stage.replay({});
    std::vector<Image> images = movingWall();
    images.pop_back();
    writeRecording(stage / "short", images);
    images.resize(5, bumpImage());
    writeRecording(stage / "long", images);
    const std::string replay = (stage / "out").string(), mcap = (stage / "mcap").string();
    checkRefusal(
        {"convert", (stage / "short").string(), "--out", mcap, "--format", "mcap", "--replay", replay},
        {"frames.csv: index: 2", "0 to 1"});
    CHECK(!std::filesystem::exists(stage / "mcap/recording.mcap"));
    const ProgramRun run = runFathom(
        {"convert", (stage / "long").string(), "--out", mcap, "--format", "mcap", "--replay", replay});
    CHECK_MESSAGE(run.exitCode == 0, run.err);
    CHECK(run.err.find("frames.csv: the replay played 3 of 5 frames of the source") != std::string::npos);
}

TEST_CASE("convert rejects a live camera, a format that it does not write, and folders that hold something") {
    const Stage stage;
    stage.recording(movingWall());
    const std::string source = (stage / "rec").string(), out = (stage / "new").string();
    checkRefusal({"convert", source, "--out", out, "--format", "bag"}, {"--format", "bag", "tum, mcap"});
    checkRefusal({"convert", source, "--out", out, "--replay", out}, {"--replay", "--format mcap"});
    checkRefusal({"convert", source, "--out", source}, {"--out", "associations.txt"});
    checkRefusal({"convert", source, "--out", out, "--format", "mcap", "--replay", source}, {"haptics.csv"});
    stage.write("new/recording.mcap", "x");
    checkRefusal({"convert", source, "--out", out, "--format", "mcap"}, {"recording.mcap", "exists"});
    checkRefusal({"convert", (stage / "nowhere").string(), "--out", out}, {"nowhere", "missing"});
}
