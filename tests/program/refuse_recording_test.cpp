// SPDX-License-Identifier: Apache-2.0
// Rejected: unusable recordings, invalid hand paths and command lines, and output that cannot be written.
#include "tests/rig/program_refusal.h"

#include <doctest/doctest.h>

using namespace fathom;

namespace {

namespace fs = std::filesystem;

// Checks the message for intrinsics.json with `from` replaced by `to`.
void checkIntrinsics(const std::string& from, const std::string& to, const std::vector<std::string>& parts) {
    Stage stage;
    stage.recording({bumpImage()});
    std::string text = lensJson(kWidth, kHeight);
    const size_t at = text.find(from);
    REQUIRE(at != std::string::npos);
    stage.write("rec/intrinsics.json", text.replace(at, from.size(), to));
    INFO(text);
    checkRefused(stage, parts);
}

} // namespace

TEST_CASE("A recording folder that is missing, empty, a file or without an index is rejected") {
    Stage stage;
    const std::string folder = (stage / "rec").string();
    checkRefused(stage, {folder, "missing", "a recording folder"}, {"--source", folder});
    stage.write("rec", "a file");
    checkRefused(stage, {folder, "folder", "allowed: "});
    fs::remove(stage / "rec");
    fs::create_directories(stage / "rec");
    checkRefused(stage, {folder, "folder", "empty", "allowed: "});

    stage.recording({bumpImage()});
    fs::remove(stage / "rec/associations.txt");
    checkRefused(stage, {folder, "associations.txt", "missing"});
    stage.write("rec/associations.txt", "# nothing\n");
    checkRefused(stage, {folder, "associations.txt", "no pair of images", "at least one"});
    fs::remove(stage / "rec/intrinsics.json");
    checkRefused(stage, {"intrinsics.json", "missing"});
}

TEST_CASE("A recording without a usable frame is rejected in one line that names the first fault") {
    Stage stage;
    stage.recording({bumpImage(), bumpImage(), bumpImage()});
    for (const char* name : {"rec/depth/000000.png", "rec/depth/000001.png", "rec/depth/000002.png"}) {
        const std::string whole = stage.read(name);
        stage.write(name, whole.substr(0, whole.size() / 2));
    }
    checkRefused(stage, {(stage / "rec").string(), "frames", "none of 3", "depth/000000.png",
                         "at least one usable pair"});
    fs::remove_all(stage / "rec/depth");
    checkRefused(stage, {"frames", "none of 3", "depth/000000.png", "no such file"});
    stage.write("rec/associations.txt", "this is no index\n");
    checkRefused(stage, {"frames", "none of 1", "line 1"});
}

TEST_CASE("Colour of another size than depth without registration is rejected") {
    Stage stage;
    stage.recording({bumpImage(), bumpImage()});
    for (const char* name : {"rec/rgb/000000.png", "rec/rgb/000001.png"}) {
        writeColour(stage / name, 32, 24, 200, 20, 20);
    }
    checkRefused(stage, {"intrinsics.json", "32x24", "64x48", "extrinsics_topic_tf"});
}

TEST_CASE("Intrinsics that are zero, negative, not a number, missing or too large are rejected") {
    checkIntrinsics("\"fx\": 60", "\"fx\": NaN", {"intrinsics.json", "fx", "N", "NaN"});
    checkIntrinsics("\"fx\": 60", "\"fx\": 0", {"intrinsics.json: fx: 0 ", "above 0"});
    checkIntrinsics("\"fy\": 60", "\"fy\": -60", {"intrinsics.json: fy: -60 ", "above 0"});
    checkIntrinsics("\"fy\": 60", "\"fy\": \"60\"", {"intrinsics.json: fy: \"60\"", "above 0"});
    checkIntrinsics("\"fy\": 60", "\"f\": 60", {"intrinsics.json: fy: missing"});
    checkIntrinsics("\"cx\": 31.5", "\"cx\": null", {"intrinsics.json: cx: null", "finite"});
    checkIntrinsics("\"width\": 64", "\"width\": 0", {"intrinsics.json: width: 0", "1 to 3840"});
    checkIntrinsics("\"width\": 64", "\"width\": 4096", {"intrinsics.json: width: 4096", "1 to 3840"});
    checkIntrinsics("0.001", "0", {"intrinsics.json: depth_scale_m_per_unit: 0", "above 0"});
    checkIntrinsics("[]", "[0.1, 0, 0, 0]", {"intrinsics.json: distortion_model: \"none\"", "plumb_bob"});
    checkIntrinsics("\"none\", \"distortion\": []", "\"plumb_bob\", \"distortion\": [1e9, 0, 0, 0]",
                    {"intrinsics.json: distortion", "1000000000", "inverted"});
    checkIntrinsics("true", "false", {"intrinsics.json: registered_to_color: false", "extrinsics_topic_tf"});
}

TEST_CASE("A poses.txt with an invalid number is rejected with its line") {
    Stage stage;
    stage.recording({bumpImage()});
    stage.write("rec/poses.txt", "0 0 0 0 0 0 0 1\n1 0 nan 0 0 0 0 1\n");
    checkRefused(stage, {"poses.txt", "line 2", "nan", "eight finite numbers"});
}

TEST_CASE(
    "A hand path that is missing, empty, malformed or goes back in time is rejected with line and column") {
    Stage stage;
    stage.recording({bumpImage()});
    const std::string header = "t_s,x,y,z,qw,qx,qy,qz,button\n", path = (stage / "hand.csv").string();
    checkRefused(stage, {"absent.csv", "no such file"}, {"--operator", (stage / "absent.csv").string()});
    const auto refused = [&](const std::string& text, const std::vector<std::string>& parts) {
        stage.write("hand.csv", text);
        INFO(text);
        std::vector<std::string> all = parts;
        all.push_back(path);
        all.push_back("allowed: ");
        checkRefused(stage, all);
    };
    refused("", {"line 1", "header"});
    refused(header, {"line 2", "at least one row"});
    refused("t,x,y,z\n0,0,0,0\n", {"line 1", "t,x,y,z", "t_s,x,y,z,qw,qx,qy,qz[,button]"});
    refused(header + "0,0,0,oops,1,0,0,0,0\n", {"line 2, z", "'oops'", "finite"});
    refused(header + "0,0,0,nan,1,0,0,0,0\n", {"line 2, z", "'nan'", "finite"});
    refused(header + "0,0,0,0,0,0,0,0,0\n", {"line 2", "0,0,0,0", "non-zero length"});
    refused(header + "0,0,0,0,1,0,0,0,-1\n", {"line 2, button", "'-1'", "whole number"});
    refused(header + "0,0,0,0,1,0,0,0,0\n1,0,0,0,1,0,0,0\n", {"line 3", "8 fields", "9"});
    refused(header + "1,0,0,0,1,0,0,0,0\n0.5,0,0,0,1,0,0,0,0\n", {"line 3, t_s", "'0.5'", "later"});
}

TEST_CASE("An invalid command line is rejected with what is allowed") {
    Stage stage;
    stage.recording({bumpImage()});
    const std::string scene = (stage / "scene.yaml").string(), out = (stage / "out").string();
    checkRefusal({}, {"subcommand", "missing", "replay", "plan"});
    checkRefusal({"repaly", scene}, {"subcommand", "'repaly'", "replay", "plan"});
    checkRefusal({"replay"}, {"replay", "SCENE"});
    checkRefusal({"replay", scene}, {"replay", "--out"});
    checkRefusal({"replay", scene, "--out"}, {"replay", "--out"});
    checkRefusal({"replay", scene, "--out", out, "--fast"},
                 {"replay", "'--fast'", "--source", "--operator", "--device"});
    checkRefusal({"replay", scene, "--out", out, "more"}, {"replay", "'more'"});
    checkRefused(stage, {"--query", "both", "cpu", "gpu"}, {"--query", "both"});
    checkRefused(stage, {"device", "no such thing", "0 = "}, {"--device", "no such thing"});
    checkRefused(stage, {"device", "99", "0 = "}, {"--device", "99"});
}

TEST_CASE("An output folder that is a file is rejected; one that holds a folder in the way is a failure") {
    Stage stage;
    stage.recording({bumpImage()});
    stage.hand({{0.0, {0.0, 0.0, 0.4}}});
    stage.write("file", "in the way");
    const std::string rec = (stage / "rec").string();
    for (const char* name : {"file", "file/deep"}) {
        const std::string out = (stage / name).string();
        const std::vector<std::string> parts{out + ": output folder: ",
                                             "(allowed: a folder, existing or new"};
        checkRefusal(stage.command({}, name), parts);
        checkRefusal({"convert", rec, "--out", out}, parts);
        checkRefusal({"record", "apps/scenes/demo.yaml", "--source", rec, "--out", out}, parts);
        const ProgramRun run = runFathom({"inspect", rec, "--out", out});
        CHECK(run.exitCode == 2);
        CHECK(run.err.find(parts[0]) != std::string::npos);
    }
    fs::create_directories(stage / "out/summary.json/full");
    checkRefusal(stage.command(), {(stage / "out/summary.json").string(), "cannot replace"}, 1);
    fs::create_directories(stage / "out2/haptics.csv.partial");
    checkRefusal(stage.command({}, "out2"), {(stage / "out2/haptics.csv").string(), "cannot create"}, 1);
}

TEST_CASE("Help goes to standard output with exit code 0") {
    for (const std::vector<std::string>& words :
         std::vector<std::vector<std::string>>{{"--help"}, {"replay", "--help"}, {"plan", "--help"}}) {
        const ProgramRun run = runFathom(words);
        CHECK(run.exitCode == 0);
        CHECK(run.err == "");
        CHECK(run.out.find("Usage") != std::string::npos);
    }
}
