// SPDX-License-Identifier: Apache-2.0
// Damaged, empty, full and unusual frames: skipped with a message, or processed.
#include "tests/rig/stage.h"
#include "tests/support/replace_in.h"

#include <algorithm>
#include <doctest/doctest.h>
#include <unistd.h>

using namespace fathom;

namespace {

// Checks that a recording of four frames with frame `bad` damaged runs, counts it as skipped and names it in
// one line.
void checkSkips(const Stage& stage, int bad, const std::vector<std::string>& parts) {
    stage.hand({{0.0, {0.0, 0.0, 0.4}}});
    const ProgramRun run = runFathom(stage.command());
    CAPTURE(run.err);
    REQUIRE(run.exitCode == 0);
    CHECK(run.errorLines().size() == 1);
    CHECK(run.err.find("frame " + std::to_string(bad) + " skipped") != std::string::npos);
    for (const std::string& part : parts) {
        CAPTURE(part);
        CHECK(run.err.find(part) != std::string::npos);
    }
    const Replay replay = readReplay(stage / "out", run);
    checkContract(replay, {});
    CHECK(replay.summary.at("frames").at("count") == 3);
    CHECK(replay.summary.at("frames").at("skipped") == 1);
    CHECK(run.out.find("3 used, 1 skipped") != std::string::npos);
    std::vector<uint32_t> used;
    for (const FrameRow& row : replay.frames) {
        used.push_back(row.index);
    }
    std::vector<uint32_t> wanted{0, 1, 2, 3};
    wanted.erase(wanted.begin() + bad);
    CHECK(used == wanted);
    if (bad != 3) { // the run lasts until 1/30 s after the last good frame
        CHECK(replay.ticks.size() == 134);
    }
}

void withFour(const std::function<void(const Stage&)>& damage, int bad,
              const std::vector<std::string>& parts) {
    Stage stage;
    stage.recording(std::vector<Image>(4, bumpImage()));
    damage(stage);
    checkSkips(stage, bad, parts);
}

// The same for one change of the index.
void withIndexChanged(const std::string& from, const std::string& to, int bad,
                      const std::vector<std::string>& parts) {
    withFour([&](const Stage& stage) { testing::replaceIn(stage / "rec/associations.txt", from, to); }, bad,
             parts);
}

} // namespace

TEST_CASE("A truncated, missing or wrong frame in a good recording is skipped alone and named") {
    withFour(
        [](const Stage& s) {
            const std::string whole = s.read("rec/depth/000001.png");
            s.write("rec/depth/000001.png", whole.substr(0, whole.size() / 2));
        },
        1, {"depth/000001.png"});
    withFour([](const Stage& s) { s.write("rec/rgb/000002.png", ""); }, 2, {"rgb/000002.png"});
    withFour([](const Stage& s) { std::filesystem::remove(s / "rec/depth/000003.png"); }, 3,
             {"depth/000003.png"});
    withFour([](const Stage& s) { std::filesystem::remove(s / "rec/depth/000000.png"); }, 0,
             {"depth/000000.png"});
    withFour([](const Stage& s) { writeDepth(s / "rec/depth/000001.png", 32, 24, 600); }, 1,
             {"32x24", "64x48"});
    withFour([](const Stage& s) { writeColour(s / "rec/depth/000001.png", kWidth, kHeight, 1, 2, 3); }, 1,
             {"16-bit grey"});
    withFour(
        [](const Stage& s) {
            writePng(s / "rec/depth/000002.png", kWidth, kHeight, 8, 0,
                     std::vector<uint8_t>(kWidth * kHeight, 60));
        },
        2, {"8-bit", "16-bit grey"});
}

TEST_CASE(
    "Where standard streams are closed, a warning is not written into results, which stay the same, and "
    "a closed standard output is an error") {
    const Stage stage;
    stage.recording(std::vector<Image>(4, bumpImage()));
    std::filesystem::remove(stage / "rec/depth/000001.png"); // the cause of the warning
    stage.hand({{0.0, {0.0, 0.0, 0.4}}});
    struct Case {
        std::string name;
        std::vector<int> closed;
        int exitCode;
    };
    for (const Case& c :
         {Case{"open", {}, 0}, Case{"error", {STDIN_FILENO, STDERR_FILENO}, 0},
          Case{"output", {STDOUT_FILENO}, 1}, Case{"all", {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}, 1}}) {
        CAPTURE(c.name);
        RunSetting streams;
        streams.closed = c.closed;
        const std::string mcap = (stage / c.name / "mcap").string();
        for (const auto& words : {stage.command({}, c.name),
                                  {"convert", (stage / "rec").string(), "--format", "mcap", "--out", mcap}}) {
            const ProgramRun run = runFathom(words, streams);
            CHECK(run.exitCode == c.exitCode);
            CHECK((run.err.find("standard output: cannot be written") != std::string::npos) ==
                  (c.name == "output"));
        }
        CHECK(stage.read(c.name + "/haptics.csv") == stage.read("open/haptics.csv"));
        CHECK(stage.read(c.name + "/mcap/recording.mcap") == stage.read("open/mcap/recording.mcap"));
        CHECK(readFrames(stage / c.name / "frames.csv").size() == 3);
    }
}

TEST_CASE("A stamp that goes back, or an invalid line, skips its frame alone and is named") {
    withIndexChanged("0.066667 depth/000002", "0.010000 depth/000002", 2, {"0.01", "goes back"});
    withIndexChanged("0.033333 rgb/000001.png", "noise rgb/000001.png", 1, {"line 3"});
    withIndexChanged("0.033333 rgb/000001.png ", "", 1, {"line 3"});
}

TEST_CASE("Frames without valid depth, with every pixel selected and with none selected run through") {
    Stage stage;
    const PixelBox all{0, 0, kWidth, kHeight};
    stage.recording({Image(kWidth, kHeight, 600).paint(all, kRed), Image(kWidth, kHeight, 0).paint(all, kRed),
                     Image(kWidth, kHeight, 600), Image(kWidth, kHeight, 65535).paint(all, kRed),
                     Image(kWidth, kHeight, 600).paint(all, kRed)});
    SceneText scene;
    scene.fixtures.push_back(SceneText::kGuideYellow);
    scene.more = "hold_s: 0\nerror_budget: 0\n";
    stage.scene(scene);
    stage.hand({{0.0, {0.0, 0.0, 0.5}}, {0.17, {0.0, 0.0, 0.57}}});
    Terms terms;
    terms.empty = "yellow";
    const Replay replay = stage.replay({"--save-fixtures"}, terms);
    const uint64_t whole = kWidth * kHeight;
    const std::vector<uint64_t> valid{whole, 0, whole, 0, whole}, forbidden{whole, 0, 0, 0, whole};
    for (size_t i = 0; i < 5; ++i) {
        CAPTURE(i);
        CHECK(replay.frames.at(i).valid == valid[i]);
        CHECK(replay.frames.at(i).forbidden == forbidden[i]);
        CHECK(replay.frames.at(i).spheres == forbidden[i]); // budget 0 keeps every point of a wall
    }
    CHECK(replay.frames.at(0).patches == 12);
}

TEST_CASE("A forbidden point without depth is held for hold_s, and one with a deeper pixel goes at once") {
    Stage stage;
    const PixelBox box{24, 14, 44, 34};
    const auto seen = [&] { return Image(kWidth, kHeight, 800).set(box, 600).paint(box, kRed); };
    std::vector<Image> images{seen()};
    for (int i = 0; i < 4; ++i) {
        images.push_back(seen().set(box, 0)); // 1 to 4: no depth in the box
    }
    images.push_back(seen());                      // 5: as before
    images.push_back(seen().set(box, 300));        // 6: a nearer red surface, which is forbidden, too
    images.push_back(Image(kWidth, kHeight, 800)); // 7: gone, only the wall behind
    stage.recording(images);
    SceneText scene;
    scene.more = "hold_s: 0.08\n"; // [s] frames at 1/30 and 2/30 s hold it, at 3/30 s not
    scene.filter = "radius: 0";
    stage.scene(scene);
    stage.hand({{0.0, {0.0, 0.0, 0.5}}, {0.03, {0.0, 0.0, 0.56}}, {0.27, {0.0, 0.0, 0.56}}});
    Terms terms;
    terms.warning = "a region disappeared at 0.10 s while it pressed: fixture 'red' has no region: no pixel";
    const Replay replay = stage.replay({"--save-fixtures"}, terms);
    const auto held = [&](int frame) {
        const std::vector<SavedSphere> all = readPly(replay.ply(frame));
        return std::count_if(all.begin(), all.end(), [](const SavedSphere& s) { return s.held != 0; });
    };
    const auto first = static_cast<int64_t>(replay.frames.at(0).spheres);
    CHECK(first > 50);
    CHECK(held(0) == 0);
    for (int frame : {1, 2}) {
        CHECK(replay.frames.at(static_cast<size_t>(frame)).forbidden == 0);
        CHECK(held(frame) == first);
    }
    CHECK(replay.frames.at(3).spheres == 0);
    CHECK(replay.frames.at(4).spheres == 0);
    CHECK(held(5) == 0);
    CHECK(held(6) == first);
    CHECK(replay.frames.at(7).spheres == 0);
    CHECK(replay.at(0.09).state == "contact"); // stopped by held points
    CHECK(replay.at(0.09).tool.position.z < 0.551);
    CHECK(replay.at(0.16).state == "fading"); // nothing is left
    // The tool stays where the region vanished under it; the hand map takes up the distance to the hand.
    CHECK(replay.at(0.16).tool.position.z == doctest::Approx(replay.at(0.09).tool.position.z).epsilon(0.002));
    CHECK(replay.at(0.16).device.position.z == doctest::Approx(replay.at(0.16).tool.position.z));
    CHECK(replay.haptic().at("regions_vanished") >= 1);
}

TEST_CASE("Frames of odd sizes run, from one pixel on") {
    for (const auto& [width, height] : {std::pair{1u, 1u}, std::pair{17u, 1u}, std::pair{7u, 5u},
                                        std::pair{33u, 17u}, std::pair{257u, 3u}}) {
        const uint32_t across = width; // clang 14 cannot capture a structured binding
        CAPTURE(across);
        Stage stage;
        stage.recording(
            {Image(width, height, 500).paint({0, 0, width, height}, kRed), Image(width, height, 500)});
        stage.hand({{0.0, {0.0, 0.0, 0.4}}, {0.05, {0.0, 0.0, 0.47}}});
        Terms terms;
        terms.empty = across == 1 ? "red" : ""; // a single pixel is isolated
        const Replay replay = stage.replay({"--save-fixtures"}, terms);
        CHECK(replay.frames.at(0).forbidden == width * height);
        CHECK(replay.frames.at(1).forbidden == 0);
    }
}

TEST_CASE("Colour of another size with extrinsics is looked up through the registration") {
    Stage stage;
    const PixelBox all{0, 0, kWidth, kHeight};
    stage.recording({Image(kWidth, kHeight, 600).paint(all, kRed)});
    writeColour(stage / "rec/rgb/000000.png", 128, 96, 200, 20, 20);
    stage.write("rec/intrinsics.json", R"({"registered_to_color": false, "depth_scale_m_per_unit": 0.001,
 "depth": {"width": 64, "height": 48, "fx": 60, "fy": 60, "cx": 31.5, "cy": 23.5, "distortion": []},
 "color": {"width": 128, "height": 96, "fx": 120, "fy": 120, "cx": 63.5, "cy": 47.5, "distortion": []},
 "extrinsics_topic_tf": {"Depth": {"t": [0, 0, 0], "q_xyzw": [0, 0, 0, 1]}, "Color": {"t": [0.015, 0, 0], "q_xyzw": [0, 0, 0, 1]}}})");
    stage.hand({{0.0, {0.0, 0.0, 0.5}}, {0.1, {0.0, 0.0, 0.56}}});
    const Replay replay = stage.replay();
    // 15 mm to the right at 600 mm: 3 columns of colour pixels, or 1.5 of depth pixels, leave the image.
    CHECK(replay.frames.at(0).valid == kWidth * kHeight);
    CHECK(replay.frames.at(0).forbidden >= 62 * kHeight);
    CHECK(replay.frames.at(0).forbidden <= 63 * kHeight);
    CHECK(replay.frames.at(0).times.count("occlusion_ms") == 1);
}
