// SPDX-License-Identifier: Apache-2.0
// Inputs that must not be taken silently: absurd numbers, outputs over inputs, runs without protection,
// registrations that cannot be right.
#include "tests/rig/program_refusal.h"
#include "tests/support/mentions.h"

#include <doctest/doctest.h>
#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

using namespace fathom;
using fathom::testing::mentions;

namespace {

// Two frames of a red bump, and a hand in front of it.
struct SimpleStage : Stage {
    SimpleStage() {
        recording({bumpImage(), bumpImage()});
        scene({});
        hand({{0.0, {0.0, 0.0, 0.4}}, {0.1, {0.0, 0.0, 0.41}}});
    }
};

} // namespace

TEST_CASE("Numeric options reject NaN, infinity and numbers out of range in one line with the range") {
    const SimpleStage stage;
    const std::string scene = (stage / "scene.yaml").string(), out = (stage / "out").string();
    for (const char* bad : {"nan", "inf", "1e300", "-1", "0x10", "1s"}) {
        CAPTURE(bad);
        const auto refused = [&](std::vector<std::string> command, const std::string& option) {
            command.insert(command.end(), {option, bad});
            checkRefusal(command, {option, bad, "allowed: "});
        };
        refused({"replay", scene, "--realtime", "--out", out}, "--seconds");
        refused({"replay", scene, "--realtime", "--out", out}, "--frame-rate");
        refused({"operate", scene}, "--seconds");
        refused({"operate", scene}, "--text-scale");
        refused({"record", scene, "--out", out}, "--seconds");
        refused({"latency", scene}, "--seconds");
        refused({"latency", scene}, "--soak");
        refused({"arm-simulator", "eca_5e"}, "--seconds");
        refused({"register", scene, "--points", scene}, "--bound");
        refused({"spheres", "a.obj", "--out", "a.sph"}, "--scale");
        refused({"spheres", "a.obj", "--out", "a.sph"}, "--protrusion");
        refused({"spheres", "a.obj", "--out", "a.sph"}, "--leaves");
        refused({"register", scene, "--tags", scene}, "--frames");
        refused({"tune", scene, "--error", "1", "--out", out}, "--frames");
    }
}

TEST_CASE("latency rejects options that a soak has no use for, and tries its report before the work") {
    const SimpleStage stage;
    const std::string scene = (stage / "scene.yaml").string();
    checkRefusal({"latency", scene, "--soak", "0.02", "--load", "window"}, {"--load: given with --soak"});
    checkRefusal({"latency", scene, "--soak", "0.02", "--seconds", "3"}, {"--seconds: given with --soak"});
    checkRefusal({"latency", scene, "--out", (stage / "no/l.json").string()},
                 {"latency: --out: ", "no/l.json"});
    checkRefusal({"latency", scene, "--load", "idle", "--seconds", "0.5", "--out", scene},
                 {scene + ": output: the input itself"}); // before the measurement, which prints
}

TEST_CASE("A hand path in seconds since 1970 or with huge positions is rejected with line and column") {
    const SimpleStage stage;
    stage.hand({{1700000000.0, {0.0, 0.0, 0.4}}, {1700000001.0, {0.0, 0.0, 0.4}}});
    checkRefused(stage, {"hand.csv", "line 2, t_s", "1700000000", "from the start of the run"});
    stage.hand({{0.0, {0.0, 1e7, 0.4}}});
    checkRefused(stage, {"hand.csv", "line 2, y", "1000 km"});
}

TEST_CASE("A lens of absurd focal length is rejected with its value") {
    const SimpleStage stage;
    std::string lens = stage.read("rec/intrinsics.json");
    const size_t at = lens.find("\"fx\"");
    REQUIRE(at != std::string::npos);
    lens.replace(at, lens.find(',', at) - at, "\"fx\": 1e300");
    stage.write("rec/intrinsics.json", lens);
    checkRefused(stage, {"recorded ", "depth fx: 1e+300", "a number from 0.001 to"});
}

TEST_CASE("A second run on an output folder in use is rejected in one line, and the folder stays as it is") {
    const SimpleStage stage;
    std::filesystem::create_directories(stage / "out");
    const std::filesystem::path lock = stage / "out/.fathom.lock";
    const int held = ::open(lock.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
    REQUIRE(held >= 0);
    REQUIRE(::flock(held, LOCK_EX) == 0);
    checkRefusal(stage.command(), {(stage / "out").string(), "in use by another process"});
    CHECK_FALSE(std::filesystem::exists(stage / "out/summary.json"));
    checkRefusal({"record", (stage / "scene.yaml").string(), "--source", (stage / "rec").string(), "--out",
                  (stage / "out").string()},
                 {"in use by another process"});
    ::close(held); // as when that process ends: its file stays, and does not count
    stage.replay();
    CHECK_FALSE(std::filesystem::exists(lock));
}

TEST_CASE("No command replaces a file that it reads") {
    const SimpleStage stage;
    const std::string scene = (stage / "scene.yaml").string();
    stage.write("ball.obj", "v 0 0 0\nv 0.1 0 0\nv 0 0.1 0\nv 0 0 0.1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n");
    std::filesystem::create_symlink(stage / "ball.obj", stage / "link.sph");
    std::filesystem::create_hard_link(stage / "ball.obj", stage / "same.sph");
    stage.write("tool.sph", "1 1\n0 0 0 0.01\n");
    stage.write("points.csv", "0,0,1,0,0,1\n0.5,0,1,0.5,0,1\n0,0.5,1,0,0.5,1\n0.5,0.5,1.5,0.5,0.5,1.5\n");
    const auto refused = [&](const std::vector<std::string>& command, const std::string& file) {
        CAPTURE(file);
        const std::string before = stage.read(file);
        const ProgramRun run = runFathom(command);
        CHECK(run.exitCode == 2);
        REQUIRE(run.errorLines().size() == 1);
        mentions(run.err, "the input itself");
        CHECK(stage.read(file) == before);
    };
    const auto at = [&](const char* name) { return (stage / name).string(); };
    refused({"spheres", at("ball.obj"), "--out", at("ball.obj")}, "ball.obj");
    refused({"spheres", at("ball.obj"), "--out", at("link.sph")}, "ball.obj");
    refused({"spheres", at("ball.obj"), "--out", at("same.sph")}, "ball.obj");
    refused({"spheres", at("tool.sph"), "--out", at("tool.sph")}, "tool.sph");
    refused({"register", scene, "--points", at("points.csv"), "--out", at("points.csv")}, "points.csv");
    refused({"register", scene, "--points", at("points.csv"), "--out", scene}, "scene.yaml");
    std::filesystem::create_directories(stage / "out");
    std::filesystem::copy(stage / "hand.csv", stage / "out/haptics.csv");
    refused({"replay", scene, "--source", at("rec"), "--operator", at("out/haptics.csv"), "--out", at("out")},
            "out/haptics.csv");
    refused(stage.command({"--trace", scene}), "scene.yaml");
    refused(stage.command({"--trace", at("hand.csv")}), "hand.csv");
    const auto operated = [&](const std::string& state) {
        return std::vector<std::string>{"operate",   scene,      "--source",    at("rec"),
                                        "--device",  "llvmpipe", "--offscreen", "640x480",
                                        "--seconds", "0.1",      "--state",     state};
    };
    refused(operated(scene), "scene.yaml");
    refused(operated(at("rec/associations.txt")), "rec/associations.txt");
    REQUIRE(runFathom({"convert", at("rec"), "--out", at("mcap"), "--format", "mcap"}).exitCode == 0);
    const std::string mcap = at("mcap/recording.mcap");
    const std::string before = stage.read("mcap/recording.mcap");
    const ProgramRun run =
        runFathom({"replay", scene, "--source", mcap, "--out", at("mcap_out"), "--trace", mcap});
    CHECK(run.exitCode == 2);
    mentions(run.err, mcap + ": output: the input itself");
    CHECK(stage.read("mcap/recording.mcap") == before);
    SceneText withPath;
    withPath.hand = "path: hand.csv";
    stage.scene(withPath);
    refused(operated(at("hand.csv")), "hand.csv");
}

TEST_CASE("Spheres of a needle of 0.5 m by 1 nm are made in seconds and contain it") {
    const Stage stage;
    stage.write("needle.obj", "v 0 0 0\nv 0.5 0 0\nv 0.25 1e-09 0\nv 0.25 0 1e-09\n"
                              "f 1 2 3\nf 1 2 4\nf 2 3 4\nf 1 3 4\n");
    RunSetting setting;
    setting.timeLimit = 60.0;
    const ProgramRun run = runFathom(
        {"spheres", (stage / "needle.obj").string(), "--out", (stage / "needle.sph").string()}, setting);
    CHECK(run.exitCode == 0);
    mentions(run.out, "every surface sample is inside a sphere");
}

TEST_CASE("A tool whose spheres touch more than a million pairs of regions is refused in one line") {
    const SimpleStage stage;
    SceneText scene;
    scene.tool = "spheres: [";
    for (int i = 0; i < 4096; ++i) {
        scene.tool += std::string(i == 0 ? "" : ", ") + "[0, 0, 0.00" + std::to_string(i) + ", 5]";
    }
    scene.tool += "]";
    stage.scene(scene);
    const ProgramRun run = runFathom(stage.command());
    CHECK(run.exitCode != 0);
    REQUIRE(run.errorLines().size() == 2); // the first questions spheres of 5 m
    mentions(run.errorLines().back(), "4096 leaf spheres touch more than 1048576 pairs");
}

TEST_CASE("Grey images under a hue gate are a warning with class and cause, and exit code 1 with --strict") {
    Stage stage;
    stage.recording({Image(kWidth, kHeight, 600), Image(kWidth, kHeight, 600)});
    stage.scene({});
    stage.hand({{0.0, {0.0, 0.0, 0.4}}});
    const ProgramRun run = runFathom(stage.command());
    CHECK(run.exitCode == 0);
    const auto warnings = nlohmann::json::parse(stage.read("out/summary.json")).at("warnings");
    REQUIRE(warnings.size() == 1);
    mentions(warnings[0], "fixture 'red' has no region in any frame: the colour image is grey");
    mentions(run.err, "fixture 'red'");
    mentions(run.out, "warning      fixture 'red'");
    const ProgramRun strict = runFathom(stage.command({"--strict"}));
    CHECK(strict.exitCode == 1);
    mentions(strict.err, "--strict: 1 warnings; the first: fixture 'red'");
    const SimpleStage good;
    CHECK(good.replay({"--strict"}).summary.at("warnings").empty());
}

TEST_CASE("Frames without a pose are warnings of the run") {
    const SimpleStage stage;
    stage.recording({bumpImage(), bumpImage(), bumpImage(), bumpImage()}); // 1/30 s apart
    stage.write("rec/poses.txt", "0 0 0 0 0 0 0 1\n");
    const ProgramRun run = runFathom(stage.command({"--strict"}));
    CHECK(run.exitCode == 1);
    const auto summary = nlohmann::json::parse(stage.read("out/summary.json"));
    CHECK(summary.at("frames").at("skipped") == 2);
    REQUIRE(summary.at("warnings").size() == 2);
    mentions(summary.at("warnings")[0], "frame 2 skipped: its stamp 0.067 s is 0.067 s after the last pose");
}

TEST_CASE("register ends with exit code 1 and names the worst pairs of a scaled or mirrored frame") {
    const SimpleStage stage;
    const std::string scene = (stage / "scene.yaml").string();
    const auto doubted = [&](const std::string& rows, const std::string& part) {
        stage.write("points.csv", "camera_x,camera_y,camera_z,base_x,base_y,base_z\n" + rows);
        const ProgramRun run = runFathom({"register", scene, "--points", (stage / "points.csv").string(),
                                          "--out", (stage / "pose.yaml").string()});
        CHECK(run.exitCode == 1);
        REQUIRE(run.errorLines().size() == 1);
        mentions(run.err, part);
        mentions(run.err, "worst line ");
        CHECK(run.out.find("base_T_camera") == std::string::npos);
        CHECK_FALSE(std::filesystem::exists(stage / "pose.yaml"));
    };
    doubted("0,0,1,0,0,1000\n0.5,0,1,500,0,1000\n0,0.5,1,0,500,1000\n0.5,0.5,1.5,500,500,1500\n"
            "0.2,0.3,1.2,200,300,1200\n",
            "1000 times");
    doubted("0,0,1,0,0,1\n0.5,0,1,-0.5,0,1\n0,0.5,1,0,0.5,1\n0.5,0.5,1.5,-0.5,0.5,1.5\n"
            "0.2,0.3,1.2,-0.2,0.3,1.2\n",
            "mirror image");
    doubted("0,0,1,0,0,1\n0.5,0,1,0.5,0,1\n0,0.5,1,0,0.5,1\n0.5,0.5,1.5,0.5,0.5,1.5\n"
            "0.2,0.3,1.2,0.2,0.6,1.2\n0.4,0.1,0.9,0.4,0.1,0.9\n",
            "1 of 6 pairs do not fit the others; worst line 6 300 mm");
}
