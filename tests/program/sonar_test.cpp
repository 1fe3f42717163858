// SPDX-License-Identifier: Apache-2.0
// The shipped sonar scene through the whole program.
#include "tests/rig/run_fathom.h"
#include "tests/support/scratch_folder.h"

#include <doctest/doctest.h>
#include <fstream>
#include <nlohmann/json.hpp>

using namespace fathom;

TEST_CASE("The sonar scene pushes back before the tool touches steel or block, and nothing enters a region") {
    const testing::ScratchFolder scratch;
    const auto out = scratch.path() / "out";
    const ProgramRun run = runFathom({"replay", "apps/scenes/sonar.yaml", "--out", out.string()});
    INFO(run.err);
    REQUIRE(run.exitCode == 0);
    const auto summary = nlohmann::json::parse(std::ifstream(out / "summary.json"));
    CHECK(summary["haptic"]["max_penetration_m"].get<double>() <= 1e-5);
    CHECK(summary["haptic"]["max_force_N"].get<double>() > 0.5);
    REQUIRE(summary["fixtures"].size() == 2);
    for (const auto& fixture : summary["fixtures"]) {
        CHECK(fixture["points_mean"].get<double>() > 100.0);
    }
}

TEST_CASE("The plan of the sonar scene has beams and no thinning, and says why") {
    const ProgramRun run = runFathom({"plan", "apps/scenes/sonar.yaml"});
    REQUIRE(run.exitCode == 0);
    CHECK(run.out.find("3 sigma of range and beam added") != std::string::npos);
    CHECK(run.out.find("each point's sphere has its own radius") != std::string::npos);
    CHECK(run.out.find("beams at equal angles") != std::string::npos);
}

TEST_CASE("The beam section of a scene is validated") {
    const testing::ScratchFolder scratch;
    const auto file = scratch.path() / "beam.yaml";
    std::ofstream(file) << "camera: {beam: {width_deg: 95}}\n";
    const ProgramRun run = runFathom({"plan", file.string()});
    CHECK(run.exitCode == 2);
    CHECK(run.err.find("camera.beam.width_deg: 95") != std::string::npos);
}
