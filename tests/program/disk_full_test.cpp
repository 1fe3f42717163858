// SPDX-License-Identifier: Apache-2.0
// Files that cannot be written: on a full disk (files may not grow beyond a limit), in place of devices or
// inputs.
#include "tests/rig/file_size_limit.h"
#include "tests/rig/stage.h"

#include <doctest/doctest.h>
#include <map>

using namespace fathom;

namespace {

// Files of an earlier run, which must stay unchanged.
const std::map<std::string, std::string> kLeft{{"haptics.csv", "old haptics"},
                                               {"frames.csv", "old frames"},
                                               {"summary.json", "old summary"},
                                               {"traces.png", "old traces"},
                                               {"overlay.png", "old overlay"}};

void setUpFullDisk(const Stage& stage, double seconds, const std::string& full) {
    stage.recording({bumpImage(), bumpImage()});
    SceneText scene;
    scene.haptics = "rate_hz: 4000"; // a megabyte, the size of the write buffer, in 0.6 s
    stage.scene(scene);
    stage.hand({{0.0, {0.0, 0.0, 0.4}}, {seconds, {0.0, 0.0, 0.53}}});
    std::filesystem::create_directories(stage / "out");
    for (const auto& [name, text] : kLeft) {
        stage.write("out/" + name, text);
    }
    if (!full.empty()) {
        std::filesystem::create_symlink("/dev/full", stage / full);
    }
}

void checkFull(const Stage& stage, const ProgramRun& run, const std::string& named) {
    CAPTURE(run.err);
    CHECK(run.exitCode == 1);
    REQUIRE(run.errorLines().size() == 1);
    CHECK(run.err.find((stage / named).string() + ": cannot") != std::string::npos);
}

} // namespace

TEST_CASE("A disk that is full ends a replay in one line that names the file, and leaves the files of the "
          "run before unchanged") {
    for (const bool realtime : {false, true}) {
        for (const double seconds : {0.1, 1.2}) { // fails at the end, or in the middle
            CAPTURE(realtime);
            CAPTURE(seconds);
            const Stage stage;
            setUpFullDisk(stage, seconds, "");
            const FileSizeLimit small(50'000);
            checkFull(stage,
                      runFathom(stage.command(realtime ? std::vector<std::string>{"--realtime", "--hand"}
                                                       : std::vector<std::string>{})),
                      "out/haptics.csv");
            for (const auto& entry : std::filesystem::directory_iterator(stage / "out")) {
                const std::string name = entry.path().filename().string();
                CAPTURE(name);
                REQUIRE(kLeft.count(name) == 1);
                CHECK(stage.read("out/" + name) == kLeft.at(name));
            }
        }
    }
}

TEST_CASE("A trace that may not be written in the end is reported in one line after the replay's own files "
          "are written") {
    for (const bool realtime : {false, true}) {
        CAPTURE(realtime);
        const Stage stage;
        setUpFullDisk(stage, 0.4, ""); // a realtime run next to other tests skips ticks
        const std::string image = "rec/rgb/000001.png", before = stage.read(image); // read by the run
        std::vector<std::string> more{"--trace", (stage / image).string()};
        if (realtime) {
            more.insert(more.end(), {"--realtime", "--hand"});
        }
        const ProgramRun run = runFathom(stage.command(more));
        CHECK(run.exitCode == 2);
        REQUIRE(run.errorLines().size() == 1);
        CHECK(run.err.find((stage / image).string() + ": output: the input itself") != std::string::npos);
        CHECK(stage.read(image) == before);
        CHECK(readTicks(stage / "out/haptics.csv").size() > 100);
        CHECK(nlohmann::json::parse(stage.read("out/summary.json")).at("lockstep") == !realtime);
    }
}

TEST_CASE("A trace or an output in place of a device or a pipe is rejected in one line") {
    const Stage stage;
    setUpFullDisk(stage, 0.1, "trace.json");
    std::filesystem::create_symlink("/dev/full", stage / "frames.link");
    checkFull(stage, runFathom(stage.command({"--trace", (stage / "trace.json").string()})), "trace.json");
    CHECK(std::filesystem::is_symlink(stage / "trace.json"));
    std::filesystem::remove(stage / "out/frames.csv");
    std::filesystem::rename(stage / "frames.link", stage / "out/frames.csv");
    checkFull(stage, runFathom(stage.command()), "out/frames.csv");
    CHECK(std::filesystem::is_symlink(stage / "out/frames.csv"));
}
