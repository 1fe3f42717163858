// SPDX-License-Identifier: Apache-2.0
// Paths in a scene and links in a recording that lead outside their folders are used, with a warning.
#include "tests/rig/stage.h"

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

using namespace fathom;

TEST_CASE(
    "A path outside the scene's folder is used and reported in one line; a path inside is not reported") {
    Stage stage;
    stage.recording({bumpImage()});
    stage.hand({{0.0, {0.0, 0.0, 0.4}}, {0.1, {0.0, 0.0, 0.4}}});
    std::filesystem::create_directories(stage / "inner");
    std::filesystem::copy_file(stage / "hand.csv", stage / "inner/hand.csv");
    for (const std::string path : {"../hand.csv", "hand.csv"}) {
        SceneText scene;
        scene.hand = "path: " + path;
        stage.write("inner/scene.yaml", scene.text());
        const std::string file = (stage / "inner/scene.yaml").string();
        const ProgramRun run = runFathom({"replay", file, "--source", (stage / "rec").string(), "--device",
                                          "llvmpipe", "--out", (stage / "out").string()});
        CAPTURE(run.err);
        CHECK(run.exitCode == 0);
        REQUIRE(run.errorLines().size() == (path == "hand.csv" ? 0 : 1));
        if (path != "hand.csv") {
            CHECK(run.err.find(file + ": '../hand.csv' is outside the scene file's folder") !=
                  std::string::npos);
        }
    }
}

TEST_CASE("Intrinsics of a live camera outside the scene's folder are reported, too") {
    Stage stage;
    for (const std::string path : {"../../lens.json", "lens.json"}) {
        SceneText scene;
        scene.camera = "source: {v4l2: \"/dev/no_such_video,intrinsics=" + path + "\"}, near: 0.1, far: 3.0";
        stage.scene(scene);
        const ProgramRun run = runFathom({"plan", (stage / "scene.yaml").string()});
        CAPTURE(run.err);
        CHECK(run.exitCode != 0);
        const bool reported =
            run.err.find("'" + path + "' is outside the scene file's folder") != std::string::npos;
        CHECK(reported == (path != "lens.json"));
    }
}

TEST_CASE("Frames behind links to outside a recording's folder are used and reported in one line") {
    namespace fs = std::filesystem;
    Stage stage;
    stage.scene(SceneText{});
    stage.recording({bumpImage(), bumpImage(), bumpImage()});
    stage.hand({{0.0, {0.0, 0.0, 0.4}}, {0.1, {0.0, 0.0, 0.4}}});
    fs::rename(stage / "rec/rgb", stage / "elsewhere");
    for (const fs::path& to : {fs::path("pictures"), stage / "elsewhere"}) { // inside, and outside
        fs::remove_all(stage / "rec/pictures");
        fs::copy(stage / "elsewhere", stage / "rec/pictures");
        fs::remove(stage / "rec/rgb");
        fs::create_directory_symlink(to, stage / "rec/rgb");
        const ProgramRun run = runFathom(stage.command());
        CAPTURE(run.err);
        CHECK(run.exitCode == 0);
        const bool out = to.is_absolute();
        REQUIRE(run.errorLines().size() == (out ? 1 : 0));
        CHECK((!out || run.errorLines().front().find("a link points outside the recording's folder") !=
                           std::string::npos));
        CHECK(nlohmann::json::parse(stage.read("out/summary.json"))["frames"]["count"] == 3);
    }
}
