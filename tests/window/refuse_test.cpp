// SPDX-License-Identifier: Apache-2.0
#include "tests/rig/file_size_limit.h"
#include "tests/rig/run_fathom.h"
#include "tests/support/scratch_folder.h"

#include <cstdlib>
#include <doctest/doctest.h>
#include <fstream>

using namespace fathom;

namespace {

ProgramRun withDisplay(const char* display, const std::vector<std::string>& words) {
    const char* before = std::getenv("DISPLAY");
    const std::string kept = before != nullptr ? before : "";
    display != nullptr ? ::setenv("DISPLAY", display, 1) : ::unsetenv("DISPLAY");
    ProgramRun run = runFathom(words);
    before != nullptr ? ::setenv("DISPLAY", kept.c_str(), 1) : ::unsetenv("DISPLAY");
    return run;
}

} // namespace

TEST_CASE("Without a display, operate reports it in one line and exits with code 2") {
    for (const char* display : {static_cast<const char*>(nullptr), "", ":987"}) {
        const ProgramRun run =
            withDisplay(display, {"operate", "apps/scenes/demo.yaml", "--device", "llvmpipe"});
        CHECK(run.exitCode == 2);
        REQUIRE(run.errorLines().size() == 1);
        CHECK(run.errorLines()[0].find("operate: display: ") != std::string::npos);
        CHECK(run.errorLines()[0].find("--offscreen") != std::string::npos);
        CHECK(run.errorLines()[0].find("  ") == std::string::npos);
    }
}

TEST_CASE("An invalid offscreen size is rejected in one line with exit code 2") {
    for (const char* size : {"wide", "100x100", "1280", "1280x720x3", "9000x9000"}) {
        const ProgramRun run = runFathom({"operate", "apps/scenes/demo.yaml", "--offscreen", size});
        CHECK(run.exitCode == 2);
        REQUIRE(run.errorLines().size() == 1);
        CHECK(run.errorLines()[0].find(size) != std::string::npos);
    }
}

TEST_CASE(
    "A folder for the screenshot that cannot be written is rejected, and a full disk gives exit code 1") {
    const testing::ScratchFolder scratch;
    const std::filesystem::path own = scratch.path() / "own", shots = scratch.path() / "shots";
    std::ofstream(own) << "mine";
    const auto shoot = [](const std::filesystem::path& folder) {
        ProgramRun run = runFathom({"operate", "apps/scenes/demo.yaml", "--device", "llvmpipe", "--offscreen",
                                    "640x480", "--seconds", "0.1", "--folder", folder.string()});
        CAPTURE(run.err);
        CHECK(run.errorLines().size() == 1);
        return run;
    };
    const ProgramRun refused = shoot(own);
    CHECK(refused.exitCode == 2);
    CHECK(refused.err.find(own.string() + ": output folder: ") != std::string::npos);
    std::filesystem::create_directories(shots / "screenshot-1.png");
    CHECK(shoot(shots).exitCode == 2);
    std::filesystem::remove(shots / "screenshot-1.png");
    const FileSizeLimit small(20'000);
    const ProgramRun full = shoot(shots);
    CHECK(full.exitCode == 1);
    CHECK(full.err.find((shots / "screenshot-1.png").string() + ": cannot write") != std::string::npos);
}

TEST_CASE("Offscreen, the window draws without a display and without validation messages") {
    const ProgramRun run = withDisplay(nullptr, {"operate", "apps/scenes/demo.yaml", "--device", "llvmpipe",
                                                 "--offscreen", "800x500", "--validate", "--seconds", "2"});
    INFO(run.err);
    CHECK(run.exitCode == 0);
    CHECK(run.out.find("frames per second") != std::string::npos);
    CHECK(run.out.find("window       0.0") == std::string::npos);
}
