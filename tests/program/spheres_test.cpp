// SPDX-License-Identifier: Apache-2.0
// `fathom spheres` as a program.
#include "tests/model/meshes.h"
#include "tests/rig/program_refusal.h"
#include "tests/rig/run_fathom.h"
#include "tests/support/scratch_folder.h"

#include <algorithm>
#include <doctest/doctest.h>
#include <iterator>
#include <nlohmann/json.hpp>
#include <sstream>

using namespace fathom;
using namespace fathom::testing;

TEST_CASE("spheres writes a tree and a report of its checks, and compares it with octree and grid") {
    const ScratchFolder folder;
    const ObjFile mesh(boxMesh(dvec3(0.0), {0.1, 0.04, 0.03}));
    const std::string out = (folder / "tool.sph").string(), json = (folder / "tool.json").string();
    const ProgramRun run = runFathom(
        {"spheres", mesh.path().string(), "--out", out, "--leaves", "12", "--compare", "--json", json});
    CHECK(run.exitCode == 0);
    CHECK(run.err == "");
    CHECK(run.out.find("every surface sample is inside a sphere") != std::string::npos);
    std::ifstream in(json);
    const nlohmann::json report = nlohmann::json::parse(in);
    CHECK(report["mesh"]["closed"] == true);
    REQUIRE(report["covers"].size() == 3);
    CHECK(report["covers"][0]["name"] == "fathom");
    CHECK(report["covers"][0]["samples_outside"] == 0);
    CHECK(report["covers"][0]["surface_samples"] > 90'000);
    CHECK(report["covers"][0]["leaves"] <= 12);
    CHECK(report["covers"][0]["protrusion_max_m"] > 0.001);
    CHECK(std::filesystem::file_size(out) > 200);
}

TEST_CASE("spheres writes no two of its outputs to one file") {
    const ScratchFolder folder;
    const ObjFile mesh(boxMesh(dvec3(0.0), {0.1, 0.04, 0.03}));
    const std::string out = (folder / "o.sph").string();
    for (const auto& [name, file] : {std::pair("--json", out), std::pair("--plot", out),
                                     std::pair("--json", folder.path().string() + "/./o.sph")}) {
        checkRefusal({"spheres", mesh.path().string(), "--out", out, name, file},
                     {std::string("spheres: ") + name + ": " + file, "a file that no other option writes"});
    }
    const std::string report = (folder / "r").string();
    checkRefusal({"spheres", mesh.path().string(), "--out", out, "--json", report, "--plot", report},
                 {"spheres: --plot: " + report});
    CHECK(folder.files() == 0);
}

TEST_CASE("spheres decides by an ending in capital letters as by one in small ones") {
    const ScratchFolder folder;
    const std::string arm = (folder / "ARM.URDF").string();
    std::ofstream(arm) << "<robot name='r'><link name='a'><collision><geometry><sphere radius='0.1'/>"
                          "</geometry></collision></link></robot>";
    for (const std::string ending : {".XRDF", ".URDF", ".JSON", ".YAML"}) {
        std::string small = ending;
        std::ranges::transform(small, small.begin(), [](unsigned char c) { return std::tolower(c); });
        const auto written = [&](const std::string& name) {
            const ProgramRun run = runFathom({"spheres", arm, "--out", (folder / name).string()});
            CHECK_MESSAGE(run.exitCode == 0, run.err);
            std::ifstream in(folder / name);
            return std::string(std::istreambuf_iterator<char>(in), {});
        };
        CHECK(written("out" + ending) == written("out" + small));
    }
}

TEST_CASE("spheres scales a set of spheres like a mesh, and warns about a mesh of three metres") {
    const ScratchFolder folder;
    const ObjFile large(boxMesh(dvec3(0.0), {3.0, 0.4, 0.4}));
    const std::string whole = (folder / "whole.sph").string(), half = (folder / "half.sph").string();
    const ProgramRun run = runFathom({"spheres", large.path().string(), "--out", whole, "--leaves", "8"});
    CHECK(run.exitCode == 0);
    REQUIRE(run.errorLines().size() == 1);
    CHECK(run.err.find("3 m large if its unit is the metre") != std::string::npos);
    CHECK(run.err.find("set the unit with --scale") != std::string::npos);
    CHECK(runFathom({"spheres", whole, "--out", half, "--scale", "0.5"}).exitCode == 0);
    std::ifstream before(whole), after(half);
    std::string header, sameHeader, line;
    std::getline(before, header);
    std::getline(after, sameHeader);
    CHECK(header == sameHeader);
    size_t spheres = 0;
    for (std::string scaled; std::getline(before, line) && std::getline(after, scaled); ++spheres) {
        std::istringstream numbers(line), halves(scaled);
        for (int k = 0; k < 4; ++k) { // x, y, z, radius
            double number = 0.0, other = 1.0;
            numbers >> number;
            halves >> other;
            const bool unused = k == 3 && number < 0.0;
            CHECK(other == doctest::Approx(unused ? number : 0.5 * number).epsilon(1e-6));
        }
    }
    CHECK(spheres > 8);
}

TEST_CASE(
    "spheres writes no URDF from an MJCF file of that ending, and warns about a link left without spheres") {
    const ScratchFolder folder;
    const ScratchFile model("arm.urdf",
                            "<mujoco><worldbody><body name='a'><geom size='0.1'/><body name='b'>"
                            "<joint name='j'/><geom size='0.02'/></body></body></worldbody></mujoco>");
    const std::string out = (folder / "out.urdf").string();
    const ProgramRun refused = runFathom({"spheres", model.path().string(), "--out", out});
    CHECK(refused.exitCode == 2);
    CHECK_MESSAGE(refused.err.find("--out: a .urdf of <mujoco> (allowed: a .yaml, .xrdf or .json, ") !=
                      std::string::npos,
                  refused.err);
    CHECK(folder.files() == 0);
    CHECK(runFathom({"spheres", model.path().string(), "--out", out, "--link", "b"}).exitCode == 0);
    const ScratchFile set("set.yaml", "collision_spheres: {a: [{center: [0, 0, 0], radius: 0.1}], "
                                      "held: [{center: [0, 0, 0], radius: -10}]}\n");
    const ProgramRun run = runFathom({"spheres", set.path().string(), "--out", out});
    CHECK(run.exitCode == 0);
    CHECK_MESSAGE(run.err.find("link held: all spheres are disabled by radii of -1 or less") !=
                      std::string::npos,
                  run.err);
}

TEST_CASE("spheres rejects unusable input in one line and with exit code 2") {
    const ScratchFolder folder;
    const std::string out = (folder / "tool.sph").string();
    const ObjFile millimetres(boxMesh(dvec3(0.0), {0.3, 0.2, 0.1}), 0.001);
    const ObjFile good(boxMesh(dvec3(0.0), dvec3(0.1)));
    const std::string set = (folder / "set.sph").string();
    REQUIRE(runFathom({"spheres", good.path().string(), "--out", set, "--leaves", "4"}).exitCode == 0);
    for (const std::vector<std::string>& arguments :
         {std::vector<std::string>{"spheres", "no/such.stl", "--out", out},
          {"spheres", millimetres.path().string(), "--out", out},
          {"spheres", good.path().string(), "--out", out, "--leaves", "0"},
          {"spheres", good.path().string(), "--out", out, "--protrusion", "1e-9"},
          {"spheres", good.path().string(), "--out", out, "--up", "w"},
          {"spheres", good.path().string(), "--out", out, "--link", "a"},
          {"spheres", set, "--out", out, "--up", "x"},
          {"spheres", set, "--out", out, "--leaves", "4"},
          {"spheres", set, "--out", out, "--scale", "0"},
          {"spheres", good.path().string(), "--out", (folder / "tool.stl").string()},
          {"spheres", good.path().string(), "--out", (folder / "tool").string()},
          {"spheres", good.path().string()}}) {
        const ProgramRun run = runFathom(arguments);
        CHECK(run.exitCode == 2);
        CHECK(run.errorLines().size() == 1);
        CHECK_FALSE(std::filesystem::exists(out));
    }
}

TEST_CASE("spheres names what is allowed for its files and numbers, before the work and with no file left") {
    const ScratchFolder folder;
    const ObjFile mesh(boxMesh(dvec3(0.0), dvec3(0.1)));
    const std::string out = (folder / "tool.sph").string(), nowhere = (folder / "no/file").string();
    const auto refused = [&](const std::vector<std::string>& more, const std::vector<std::string>& parts) {
        std::vector<std::string> arguments{"spheres", mesh.path().string()};
        arguments.insert(arguments.end(), more.begin(), more.end());
        checkRefusal(arguments, parts);
    };
    refused({"--out", (folder / "a.stl").string()}, {"--out: ", "a.stl", ".xrdf or .json"});
    refused({"--out", nowhere + ".sph"}, {"spheres: --out: ", "no/file.sph"});
    refused({"--out", out, "--json", nowhere}, {"spheres: --json: ", "no/file"});
    refused({"--out", out, "--plot", nowhere}, {"spheres: --plot: ", "no/file"});
    refused({"--out", out, "--leaves", "-1"}, {"--leaves", "-1", "a whole number from 1 to "});
    refused({"--out", out, "--leaves", "2.5"}, {"--leaves", "2.5", "a whole number from 1 to "});
    refused({"--out", out, "--keep-stray", "--drop-stray"}, {"--keep-stray", "excludes", "--drop-stray"});
    refused({"--out", out, "--meshes", folder.path().string()}, {"--meshes: given without shapes of a URDF"});
    const ScratchFile tree("ball.sph", "1 1\n0 0 0 0.01\n"), robot("arm.urdf", "<robot name='r'/>");
    const std::string links = (folder / "links.yaml").string();
    checkRefusal({"spheres", tree.path().string(), "--out", out, "--keep-stray"},
                 {"--keep-stray: given with spheres (allowed: a mesh"});
    checkRefusal({"spheres", robot.path().string(), "--out", out, "--meshes", folder.path().string()},
                 {"--meshes: given without shapes of a URDF", "--out .urdf, .yaml"});
    checkRefusal({"spheres", robot.path().string(), "--out", links, "--meshes", nowhere},
                 {"spheres: --meshes: " + nowhere + " (allowed: a folder)"});
    CHECK(folder.files() == 0);
}
