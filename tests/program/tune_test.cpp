// SPDX-License-Identifier: Apache-2.0
// `fathom tune` on a small recording: its files, the scene that replay loads, and what it rejects.
#include "tests/rig/file_size_limit.h"
#include "tests/rig/program_refusal.h"
#include "tests/support/eventually.h"

#include <csignal>
#include <doctest/doctest.h>
#include <map>

using namespace fathom;

namespace {

// A bump in front of a still camera, with a few millimetres of noise.
void stillRecording(const Stage& stage, uint32_t frames, uint16_t steps = 0) {
    std::vector<Image> images;
    uint32_t random = 1;
    for (uint32_t k = 0; k < frames; ++k) {
        Image& image = images.emplace_back(bumpImage());
        for (uint16_t& z : image.depth) {
            random = 1664525u * random + 1013904223u;
            z = static_cast<uint16_t>(z + random % 4096 / 1366 + steps * k);
        }
    }
    stage.recording(images);
}

// A scene that names files by paths relative to itself.
void scene(const Stage& stage) {
    SceneText text;
    text.camera = "source: {recorded: rec}, near: 0.1, far: 3.0";
    text.hand = "path: hand.csv";
    text.more = "error_budget: 0.0002 # my own\n";
    stage.scene(text);
    stage.hand({{0.0, {0.0, 0.0, 0.2}}, {0.2, {0.0, 0.0, 0.3}}});
}

std::vector<std::string> command(const Stage& stage, const std::vector<std::string>& more) {
    std::vector<std::string> list{"tune", (stage / "scene.yaml").string(), "--out",
                                  (stage / "tuned").string()};
    list.insert(list.end(), more.begin(), more.end());
    return list;
}

bool has(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

} // namespace

TEST_CASE("tune measures points, explains its choice in a scene that replay loads, and draws the curve") {
    const Stage stage;
    stillRecording(stage, 10);
    scene(stage);
    const ProgramRun run = runFathom(command(stage, {"--error", "50", "--frames", "8"}));
    CAPTURE(run.out);
    REQUIRE(run.exitCode == 0);
    CHECK(run.err == "");
    for (const char* part : {"truth     the mean of 10 frames", "8 frames each",
                             "skipped   memory: frames have no poses", "chosen    ", "left out"}) {
        CAPTURE(part);
        CHECK(has(run.out, part));
    }
    const std::string text = stage.read("tuned/scene.yaml");
    for (const char* part : {"# tune: written by 'fathom tune'", "# tune: filter radius ",
                             "# tune: memory 0 frames", "frames have no poses", "# tune: friction ",
                             "# tune: reach ", "# tune: image size", "# my own", "recorded: \"../rec\""}) {
        CAPTURE(part);
        CHECK(has(text, part));
    }
    CHECK(has(stage.read("tuned/points.csv"), "point,varied,filter_radius,"));
    CHECK(readImage(stage / "tuned/tune.png").width > 1000);
    CHECK(stage.read("tuned/hand.csv") == stage.read("hand.csv"));
    const ProgramRun replayed =
        runFathom({"replay", (stage / "tuned/scene.yaml").string(), "--out", (stage / "played").string()});
    CHECK(replayed.exitCode == 0);
    CHECK(readFrames(stage / "played/frames.csv").size() == 10);
}

TEST_CASE(
    "tune says which point is nearest when none meets the request, and leaves no scene of an earlier run") {
    const Stage stage;
    stillRecording(stage, 10);
    scene(stage);
    stage.write("tuned/scene.yaml", "# tune: written by 'fathom tune' 1.0\nold");
    stage.write("tuned/points.csv", "old");
    stage.write("tuned/fixtures/000000.ply", "mine");
    const ProgramRun run = runFathom(command(stage, {"--time", "0.0001", "--frames", "8", "--limit", "1"}));
    CHECK(run.exitCode == 1);
    REQUIRE(run.errorLines().size() == 1);
    CHECK(has(run.err, "no point meets the request (time at most 0.0001 ms); nearest: error "));
    CHECK(has(stage.read("tuned/points.csv"), "as written"));
    CHECK(!std::filesystem::exists(stage / "tuned/scene.yaml"));
    CHECK(stage.read("tuned/fixtures/000000.ply") == "mine");
    stage.write("proj/scene.yaml", "mine");
    checkRefusal(
        {"tune", (stage / "scene.yaml").string(), "--error", "1", "--out", (stage / "proj").string()},
        {"--out", "not a result of tune"});
    CHECK(stage.read("proj/scene.yaml") == "mine");
}

TEST_CASE("tune on a full disk leaves every file of an earlier run unchanged") {
    const Stage stage;
    stillRecording(stage, 10);
    scene(stage);
    const std::map<std::string, std::string> before{
        {"scene.yaml", "# tune: written by 'fathom tune' 1.0\nold"},
        {"points.csv", "old points"},
        {"tune.png", "old curve"}};
    for (const char* limit : {"50", "0.0001"}) { // [mm] with a chosen point, and without
        CAPTURE(limit);
        for (const auto& [name, text] : before) {
            stage.write("tuned/" + name, text);
        }
        const FileSizeLimit small(8192); // the points are fewer bytes, the image more
        const ProgramRun run = runFathom(command(stage, {"--error", limit, "--frames", "8", "--limit", "1"}));
        CHECK(run.exitCode == 1);
        CHECK_MESSAGE(has(run.err, (stage / "tuned/tune.png").string() + ": cannot"), run.err);
        for (const auto& file : before) {
            CAPTURE(file.first);
            CHECK(stage.read("tuned/" + file.first) == file.second);
        }
    }
}

TEST_CASE("tune that is ended by SIGINT writes its points and the best of them; without any, the old result "
          "stays") {
    const Stage stage;
    stillRecording(stage, 10);
    scene(stage);
    const std::string before = "# tune: written by 'fathom tune' 1.0\nold";
    stage.write("tuned/scene.yaml", before);
    stage.write("tuned/points.csv", "old");
    const auto words = command(stage, {"--error", "50", "--frames", "8"});
    pid_t program = startFathom(words, stage / "said");
    CHECK(testing::eventually([&] { return handlesInterrupt(program); }));
    CHECK(exitCodeOf(program, SIGINT) == 1);
    CHECK(has(stage.read("said"), "tune: ended by a signal before the first point"));
    CHECK(stage.read("tuned/scene.yaml") == before);
    CHECK(stage.read("tuned/points.csv") == "old");

    program = startFathom(words, stage / "said");
    CHECK(testing::eventually([&] { return has(stage.read("said"), "  1  as written"); }));
    CHECK(exitCodeOf(program, SIGINT) == 0);
    CHECK(has(stage.read("said"), "tune: ended by a signal after "));
    CHECK(has(stage.read("tuned/scene.yaml"), "a signal ended the run"));
    CHECK(has(stage.read("tuned/points.csv"), "as written"));
}

TEST_CASE("tune measures on an analytic twin when a recording shows no still scene, and says so") {
    const Stage stage;
    stillRecording(stage, 10, 20);
    scene(stage);
    const ProgramRun run = runFathom(command(stage, {"--error", "50", "--frames", "8", "--limit", "1"}));
    CAPTURE(run.out);
    CHECK(run.exitCode == 0);
    CHECK(has(run.out, "truth     an analytic twin, because camera and scene stand still in no more than"));
    CHECK(has(run.out, "the time limit of 1 s was reached"));
    CHECK(has(stage.read("tuned/scene.yaml"), "the time limit of 1 s was reached"));
}

TEST_CASE("tune rejects classes that select nothing in a recording, also where it would measure on a twin") {
    const Stage stage;
    for (const uint16_t steps : {uint16_t{0}, uint16_t{20}}) {
        CAPTURE(steps);
        stillRecording(stage, 10, steps);
        SceneText text;
        text.camera = "source: {recorded: rec}, near: 2.9, far: 3.0"; // beyond everything
        stage.scene(text);
        const ProgramRun run = runFathom(command(stage, {"--error", "50", "--frames", "8", "--limit", "1"}));
        CHECK(run.exitCode == 2);
        CHECK_MESSAGE(has(run.err, "fixtures: no forbidden class has points in these frames"), run.err);
        CHECK(!std::filesystem::exists(stage / "tuned/scene.yaml"));
        std::filesystem::remove_all(stage / "rec");
    }
}

TEST_CASE("tune rejects requests and scenes that it cannot serve, each in one line") {
    const Stage stage;
    stillRecording(stage, 1);
    scene(stage);
    checkRefusal(command(stage, {}), {"--error, --time", "neither", "exactly one of the two"});
    checkRefusal(command(stage, {"--error", "1", "--time", "1"}), {"both", "exactly one of the two"});
    checkRefusal(command(stage, {"--error", "-1"}), {"--error", "-1"});
    checkRefusal(command(stage, {"--error", "0"}), {"--error", "0.0001"});
    checkRefusal(command(stage, {"--time", "nan"}), {"--time", "nan"});
    checkRefusal(command(stage, {"--error", "1", "--frames", "3"}), {"--frames", "8"});
    checkRefusal(command(stage, {"--error", "1", "--frames", "8.5"}), {"--frames", "whole number from 8"});
    checkRefusal({"tune", (stage / "none.yaml").string(), "--error", "1", "--out", (stage / "o").string()},
                 {"none.yaml"});
    checkRefusal({"tune", (stage / "scene.yaml").string(), "--error", "1", "--out", stage.path().string()},
                 {"--out", "not replaced"});
    checkRefusal(command(stage, {"--error", "1", "--source", (stage / "nowhere").string()}), {"nowhere"});
    SceneText text;
    text.camera = "near: 0.1, far: 3.0";
    stage.scene(text);
    checkRefusal(command(stage, {"--error", "1"}), {"camera.source", "missing", "--source"});
    text.camera = "source: {recorded: rec}";
    text.fixtures = {SceneText::kGuideYellow};
    stage.scene(text);
    checkRefusal(command(stage, {"--error", "1"}), {"fixtures", "no forbidden class"});
    CHECK(!std::filesystem::exists(stage / "tuned"));
}
