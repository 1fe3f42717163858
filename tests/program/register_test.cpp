// SPDX-License-Identifier: Apache-2.0
// `fathom register` as a program: its input, its output, and that a scene accepts the result.
#include "tests/rig/stage.h"

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <glm/geometric.hpp>
#include <sstream>

using namespace fathom;

namespace {

// Points of the camera and of the base, which is rotated by 90 degrees about z and shifted: base = (-y, x, z)
// + (1, 2, 3). The last point is off by 4 mm.
constexpr const char* kPoints = "camera_x,camera_y,camera_z,base_x,base_y,base_z\n"
                                "0,0,1,1,2,4\n"
                                "0.5,0,1,1,2.5,4\n"
                                "0,0.5,1,0.5,2,4\n"
                                "0.5,0.5,1.5,0.5,2.5,4.5\n"
                                "0,0,0.5,1,2,3.504\n";

std::string lineWith(const std::string& text, const std::string& start) {
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
        if (line.starts_with(start)) {
            return line;
        }
    }
    return "";
}

double numberAfter(const std::string& line, const std::string& word) {
    const size_t at = line.find(word);
    REQUIRE(at != std::string::npos);
    return std::strtod(line.c_str() + at + word.size(), nullptr);
}

} // namespace

TEST_CASE("register prints the camera's pose and sigma and writes the same lines, and a scene accepts them") {
    const Stage stage;
    stage.recording({bumpImage()});
    stage.scene({});
    stage.write("points.csv", kPoints);
    const ProgramRun run =
        runFathom({"register", (stage / "scene.yaml").string(), "--points", (stage / "points.csv").string(),
                   "--out", (stage / "pose.yaml").string()});
    CAPTURE(run.err);
    REQUIRE(run.exitCode == 0);
    const std::string pose = lineWith(run.out, "base_T_camera:"),
                      sigma = lineWith(run.out, "registration_sigma:");
    CHECK(stage.read("pose.yaml") == pose + "\n" + sigma + "\n");
    CHECK(std::abs(numberAfter(pose, "xyz: [") - 1.0) < 0.003);
    CHECK(std::abs(numberAfter(pose, "quat_xyzw: [")) < 0.01); // rotation about z only
    const double sigmaMetres = numberAfter(sigma, "registration_sigma: ");
    CHECK(sigmaMetres > 1e-4);
    CHECK(sigmaMetres < 4e-3);

    const Replay plain = stage.replay({"--save-fixtures"}, {}, "plain");
    SceneText scene;
    scene.camera = "near: 0.1, far: 3.0, " + pose + ", " + sigma;
    stage.scene(scene);
    const Replay placed = stage.replay({"--save-fixtures"}, {}, "placed");
    // The printed pose moves each sphere, and three times the printed sigma widens it.
    double x = 0, y = 0, z = 0, qx = 0, qy = 0, qz = 0, qw = 0;
    REQUIRE(std::sscanf(pose.c_str(),
                        "base_T_camera: {xyz: [%lf, %lf, %lf], quat_xyzw: [%lf, %lf, %lf, %lf]}", &x, &y, &z,
                        &qx, &qy, &qz, &qw) == 7);
    const Pose baseTcamera{{x, y, z}, {qw, qx, qy, qz}};
    const auto before = readPly(plain.ply(0)), after = readPly(placed.ply(0));
    REQUIRE(before.size() > 100);
    REQUIRE(before.size() == after.size());
    double off = 0.0, wide = 0.0;
    for (size_t i = 0; i < before.size(); ++i) {
        off = std::max(off, glm::length(after[i].centre - baseTcamera.apply(before[i].centre)));
        wide = std::max(wide, std::abs(after[i].radius - before[i].radius - 3.0 * sigmaMetres));
    }
    CHECK(off < 1e-5);
    CHECK(wide < 1e-5);
}

TEST_CASE("register warns when all points are coplanar, and still gives the pose") {
    const Stage stage;
    stage.recording({bumpImage()});
    stage.scene({});
    const auto registered = [&](const std::string& last) {
        stage.write("points.csv", "0,0,1,0,0,1\n0.5,0,1,0.5,0,1\n0,0.5,1,0,0.5,1\n" + last);
        const ProgramRun run = runFathom(
            {"register", (stage / "scene.yaml").string(), "--points", (stage / "points.csv").string()});
        CHECK(run.exitCode == 0);
        CHECK(lineWith(run.out, "base_T_camera:") != "");
        return run.err;
    };
    CHECK(registered("0.5,0.5,1,0.5,0.5,1\n").find("all points are coplanar") != std::string::npos);
    CHECK(registered("0.5,0.5,1.2,0.5,0.5,1.2\n") == "");
}

TEST_CASE("register requires exactly one of points, tags and a board, and a writable file") {
    const Stage stage;
    stage.recording({bumpImage()});
    stage.scene({});
    stage.write("points.csv", kPoints);
    const std::string scene = (stage / "scene.yaml").string(), points = (stage / "points.csv").string();
    const auto refused = [&](std::vector<std::string> more, const std::string& part) {
        more.insert(more.begin(), {"register", scene});
        const ProgramRun run = runFathom(more);
        CHECK(run.exitCode == 2);
        REQUIRE(run.errorLines().size() == 1);
        CHECK_MESSAGE(run.errorLines()[0].find(part) != std::string::npos, run.errorLines()[0]);
    };
    refused({}, "--points, --tags, --board: none (allowed: one of them)");
    refused({"--points", points, "--tags", points}, "--points, --tags, --board: several");
    refused({"--tags", points, "--board", points}, "--points, --tags, --board: several");
    refused({"--points", points, "--out", (stage / "no/folder.yaml").string()}, "--out: ");
    refused({"--points", points, "--source", (stage / "nowhere").string()},
            "--source: given with --points (allowed: only with --tags or --board");
    refused({"--points", points, "--frames", "30"}, "--frames: given with --points");
    stage.write("board.csv", "8,5,0.04,0,0,1,0,0,0,1\n");
    const std::string board = (stage / "board.csv").string(), rec = (stage / "rec").string();
    refused({"--board", board, "--source", rec}, "(8 x 5 inner corners) in colour and depth");
    // Before any frame is taken: a missing file is named, not the missing source.
    refused({"--board", board, "--source", "nowhere", "--out", (stage / "no/folder.yaml").string()},
            "--out: ");
    refused({"--board", board, "--frames", "2.5"}, "2.5 (allowed: a whole number from 1 to 10000)");
    stage.write("tags.csv", "7,0.2,0,0,1,0,0,0,1\n");
    refused({"--tags", (stage / "tags.csv").string(), "--source", (stage / "rec").string()}, "none seen");
}
