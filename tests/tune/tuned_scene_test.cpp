// SPDX-License-Identifier: Apache-2.0
// Words and files of a tuned scene, from made-up points.
#include "apps/tune/tune_words.h"
#include "apps/tune/tuned_scene.h"
#include "engine/types/error.h"
#include "tests/support/scratch_folder.h"

#include <doctest/doctest.h>
#include <string>
#include <vector>
#include <yaml-cpp/yaml.h>

using namespace fathom;
using namespace fathom::testing;
using namespace fathom::tune;

namespace {

const std::string kSmallestScene =
    "fixtures: [{name: a, role: forbidden}]\ntool: {spheres: [[0, 0, 0, 0.01]]}\n";
const std::string kHead = std::string(kWrittenBy) + " 1.0";

// Two points that differ in memory; the second one is chosen.
TuneResult madeUp() {
    TuneResult result;
    result.points.resize(2);
    result.points[0].varied = "as written";
    result.points[0].score = {0.2, 5.0, 0.08, {}};
    result.points[1].varied = nameOf(Vary::Memory);
    result.points[1].setting.memory = 30;
    result.points[1].setting.decimation = 2;
    result.points[0].width = 640, result.points[1].width = 320;
    result.points[0].height = 480, result.points[1].height = 240;
    result.points[1].score = {0.1, 6.0, 0.001, {}};
    result.trials = {
        {Vary::Window, {}, 0, "no time"}, {Vary::Memory, {0, 1}, 1, {}}, {Vary::Size, {0, 1}, 1, {}}};
    result.choice = choose(result.scores(), {0.15, {}});
    return result;
}

} // namespace

TEST_CASE("A reason names the old value, what the new one is best in, and all that was measured") {
    const TuneResult result = madeUp();
    const TunePoint& chosen = result.points[1];
    CHECK(reasonOf(result, result.trials[1], chosen) ==
          "memory 30 frames, was 0 frames: least error, least vibration\n"
          "0 frames: error 0.2 mm, vibration 0.08 N, 5 ms; 30 frames: error 0.1 mm, vibration 0.001 N, 6 ms");
    CHECK(reasonOf(result, result.trials[0], chosen) == "filter radius 2 pixels, as before: no time");
    CHECK(noneMeets(result, {0.05, {}}).find("(error at most 0.05 mm); nearest: error 0.1 mm") !=
          std::string::npos);
    CHECK(noneMeets({}, {0.05, {}}) == "no point meets the request (error at most 0.05 mm)");
    CHECK(chosenValues(result, chosen).size() == 2); // only what was varied
    CHECK(reasonOf(result, result.trials[2], chosen)
              .find("image size 320x240, was 640x480: least error, least vibration, but misses ") == 0);
}

TEST_CASE("Stability is stated for springs below and above the passive bound, and for an unknown device") {
    TunePoint point;
    for (const auto& [margin, words] :
         {std::pair(0.25, "passive, with 0.25 N s/m"), std::pair(-0.5, "not passive"),
          std::pair(std::nan(""), "not proven")}) {
        point.felt.passive = margin;
        CHECK(stabilityOf(point).find(words) == 0);
    }
}

TEST_CASE("Values to try differ from the base in one setting, and a sigma is tried only with a filter") {
    Setting base;
    for (const Vary vary : kVaried) {
        for (const Setting& other : othersOf(base, vary)) {
            CHECK(!(other == base));
            CHECK(valueOf(other, vary) != valueOf(base, vary));
        }
        CHECK(!othersOf(base, vary).empty());
    }
    base.radius = 0;
    CHECK(othersOf(base, Vary::Sigma).empty());
    Setting other = base;
    other.friction = 0.3, other.reach = 0.2;
    CHECK(base.sameRegions(other));
    other.errorBudget = 0.5;
    CHECK(!base.sameRegions(other));
}

TEST_CASE("A tuned scene has the chosen values, copies of its files, and paths that lead to the same files") {
    const ScratchFolder scratch;
    const std::filesystem::path home = scratch.path() / "home", out = home / "deep/out";
    std::filesystem::create_directories(out);
    put(home / "path.csv", "t_s,x,y,z,qw,qx,qy,qz\n");
    put(scratch.path() / "tool.sph", "tool");
    put(home / "mine.yaml", "# mine\ncamera: {source: {recorded: 'a rec'}}\nfixtures: [{name: a, role: "
                            "forbidden}]\ntool: {file: ../tool.sph}\nhand: {path: path.csv} # my hand\n");
    const TuneResult result = madeUp();
    const TunePoint& chosen = result.points[1];
    const Scene scene = loadScene(home / "mine.yaml");
    put(out / "points.csv", "");
    for (int run = 0; run < 2; ++run) { // the second one replaces the first
        CHECK(writeTunedScene(scene, chosen.setting, chosenValues(result, chosen), kHead, out) ==
              out / "scene.yaml");
    }
    const Scene tuned = loadScene(out / "scene.yaml");
    CHECK(tuned.filter.memory == 30);
    CHECK(tuned.decimation == 2);
    CHECK(std::filesystem::equivalent(tuned.tool.file, scratch.path() / "tool.sph"));
    CHECK(std::filesystem::weakly_canonical(tuned.source.value) ==
          std::filesystem::weakly_canonical(home / "a rec"));
    CHECK(tuned.hand.path == (out / "path.csv").string());
    CHECK(textOf(out / "path.csv") == textOf(home / "path.csv"));
    const std::string text = textOf(out / "scene.yaml");
    CHECK(text.find("# tune: " + kHead + "\n# mine\n") == 0);
    CHECK(text.find("# my hand") != std::string::npos);
    CHECK(text.find("# tune: memory 30 frames") != std::string::npos);
    Scene own = loadScene(out / "scene.yaml");
    CHECK_THROWS(tunedSceneFile(own, out)); // never over its own input
    CHECK_NOTHROW(tunedSceneFile(scene, home));
    Setting wrong = chosen.setting;
    wrong.memory = 8; // differs from what the values say
    CHECK_THROWS(writeTunedScene(scene, wrong, chosenValues(result, chosen), kHead, out));
    CHECK(textOf(out / "scene.yaml") == text);
    CHECK(!std::filesystem::exists(out / "scene.new.yaml"));
}

TEST_CASE("A scene that no earlier run wrote is not replaced, nor a recording's copy of a tuned one") {
    const ScratchFolder home, out;
    home.write("mine.yaml", kSmallestScene);
    const Scene scene = loadScene(home / "mine.yaml");
    const std::string tuned = commentLines(kHead) + "camera: {}\n";
    CHECK_NOTHROW(tunedSceneFile(scene, out.path()));
    for (const std::string& text : {std::string(), std::string("camera: {}\n"), "\n" + tuned, tuned}) {
        CAPTURE(text);
        out.write("scene.yaml", text);
        CHECK_THROWS_WITH_AS(tunedSceneFile(scene, out.path()),
                             doctest::Contains("whose scene.yaml is not a result of tune"), BadInput);
    }
    out.write("points.csv", "");
    CHECK_NOTHROW(tunedSceneFile(scene, out.path()));
    std::filesystem::remove(out / "scene.yaml");
    std::filesystem::create_symlink("nowhere", out / "scene.yaml");
    CHECK_THROWS_AS(tunedSceneFile(scene, out.path()), BadInput);
}

TEST_CASE("A file that is not the scene's own is named before anything is measured") {
    const ScratchFolder home, out;
    home.write("mine.yaml", "camera: {source: {recorded: 'rec,intrinsics=lens.json'}}\n"
                            "fixtures: [{name: a, role: forbidden}]\ntool: {spheres: [[0, 0, 0, 0.01]]}\n"
                            "hand: {path: path.csv}\n");
    for (const char* name : {"path.csv", "lens.json"}) {
        CAPTURE(name);
        home.write(name, "of the scene");
        out.write(name, "another");
        CHECK_THROWS_WITH_AS(tunedSceneFile(loadScene(home / "mine.yaml"), out.path()),
                             doctest::Contains((out / name).c_str()), BadInput);
        CHECK(out.read(name) == "another");
        out.write(name, "of the scene");
    }
    CHECK_NOTHROW(tunedSceneFile(loadScene(home / "mine.yaml"), out.path()));
}

TEST_CASE("A file of the scene with the name of a result is rejected before anything is measured") {
    const ScratchFolder home;
    const auto checkRefused = [&](const std::string& name, const std::filesystem::path& out) {
        CAPTURE(name);
        home.write(name, "of the scene");
        std::vector<std::string> scenes{"camera: {source: {recorded: 'rec,intrinsics=" + name + "'}}\n"};
        if (name.ends_with(".csv")) {
            scenes.push_back("hand: {path: " + name + "}\n");
        }
        for (const std::string& text : scenes) {
            home.write("mine.yaml", kSmallestScene + text);
            CHECK_THROWS_WITH_AS(tunedSceneFile(loadScene(home / "mine.yaml"), out),
                                 doctest::Contains("another name than that of a result of tune"), BadInput);
        }
        std::filesystem::remove(home / name);
    };
    for (const char* name : {"points.csv", "tune.png", "scene.new.yaml"}) {
        checkRefused(name, home / "none");
        checkRefused(name, home.path());
    }
    checkRefused("sub/tune.png", home / "sub"); // whose copy would be sub/sub/tune.png
}

TEST_CASE("Files after the commas of a camera's source are copied or named as seen from the tuned scene") {
    const ScratchFolder scratch;
    scratch.write("lens.json", "lens");
    scratch.write("home/sub/own.json", "own");
    const std::filesystem::path home = scratch / "home", out = scratch / "results/tuned";
    std::filesystem::create_directories(out);
    const auto moved = [&](const std::string& source) {
        scratch.write("home/mine.yaml", kSmallestScene + "camera: {source: {" + source + "}}\n");
        std::filesystem::remove(out / "scene.yaml");
        std::filesystem::remove_all(out / "sub");
        const TuneResult result = madeUp();
        writeTunedScene(loadScene(home / "mine.yaml"), result.points[1].setting,
                        chosenValues(result, result.points[1]), kHead, out);
        const YAML::Node node = YAML::LoadFile((out / "scene.yaml").string());
        return node["camera"]["source"].begin()->second.as<std::string>();
    };
    CHECK(moved("recorded: 'a, rec,intrinsics=../lens.json,start=1'") ==
          "../../home/a, rec,intrinsics=../../lens.json,start=1");
    CHECK(!std::filesystem::exists(out / "sub"));
    CHECK(moved("recorded: 'rec,extrinsics=../lens.json,intrinsics=sub/own.json'") ==
          "../../home/rec,extrinsics=../../lens.json,intrinsics=sub/own.json");
    CHECK(textOf(out / "sub/own.json") == "own");
    CHECK(moved("v4l2: 'auto,intrinsics=sub/own.json'") == "auto,intrinsics=sub/own.json");
    CHECK(textOf(out / "sub/own.json") == "own");
    CHECK(moved("v4l2: 'auto,intrinsics=../lens.json,size=640x480'") ==
          "auto,intrinsics=../../lens.json,size=640x480");
    CHECK(moved("ros2: 'depth=/d,intrinsics=../lens.json,extrinsics=sub/own.json'") ==
          "depth=/d,intrinsics=../../lens.json,extrinsics=sub/own.json");
    CHECK(textOf(out / "sub/own.json") == "own");
    CHECK(moved("recorded: '/abs/rec,intrinsics=/abs/lens.json'") == "/abs/rec,intrinsics=/abs/lens.json");
}
