// SPDX-License-Identifier: Apache-2.0
// The files of a replay, and what it reports about fixtures that were edited in the recording.
#include "apps/replay/replay_recorder.h"

#include "engine/types/error.h"
#include "tests/rig/file_size_limit.h"
#include "tests/support/scratch_folder.h"

#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::testing;

namespace {

std::string classText(const std::string& name, const std::string& role) {
    return "  - { name: " + name + ", role: " + role + ", hue: [0, 20] }\n";
}

GuidancePose seen(uint32_t fixture, uint32_t count) {
    GuidancePose pose;
    pose.fixture = fixture;
    pose.count = count;
    pose.present = true;
    return pose;
}

} // namespace

TEST_CASE("A replay whose images cannot be written leaves every file of the run before as it was") {
    const ScratchFolder out;
    const std::vector<const char*> names{"haptics.csv", "frames.csv", "traces.png", "overlay.png",
                                         "summary.json"};
    for (const char* name : names) {
        out.write(name, "old");
    }
    const Scene scene;
    CameraInfo camera;
    camera.depth = {64, 48, 60.0, 60.0, 31.5, 23.5};
    ReplayRecorder::Ending ending;
    ending.camera = camera;
    const auto replay = [&] { ReplayRecorder(out.path(), scene, {camera, ""}, {}, false).finish(ending); };
    {
        const FileSizeLimit small(2000); // the header of haptics.csv, but no image
        CHECK_THROWS_WITH_AS(replay(), doctest::Contains("traces.png: cannot write"), Error);
    }
    for (const char* name : names) {
        CAPTURE(name);
        CHECK(out.read(name) == "old");
    }
    CHECK(out.files() == names.size());
    replay();
    for (const char* name : names) {
        CAPTURE(name);
        CHECK(out.read(name) != "old");
    }
}

TEST_CASE("A replay is rejected before it runs if one of its files cannot be written") {
    for (const char* name : {"haptics.csv", "frames.csv", "traces.png", "overlay.png", "summary.json"}) {
        CAPTURE(name);
        const ScratchFolder out;
        std::filesystem::create_directory(out / name);
        const Scene scene;
        CHECK_THROWS_WITH_AS(ReplayRecorder(out.path(), scene, {CameraInfo{}, ""}, {}, false),
                             doctest::Contains((out / name).c_str()), Error);
        CHECK(out.files() == 1);
    }
}

TEST_CASE("A replay without an arm removes the arm.csv and the empty fixtures/ of an earlier run, once it "
          "has succeeded, and no file of another program") {
    const ScratchFolder out;
    const Scene scene;
    CameraInfo camera;
    camera.depth = {64, 48, 60.0, 60.0, 31.5, 23.5};
    ReplayRecorder::Ending ending;
    ending.camera = camera;
    ArmSetup arm;
    arm.model.joints.push_back({"turn", false, {}, {0.0, 0.0, 1.0}, -1.0, 1.0, 1.0});
    arm.proxy.period = 0.001;
    ReplayRecorder(out.path(), scene, {camera, ""}, {}, true, &arm).finish(ending);
    CHECK(std::filesystem::exists(out / "arm.csv"));
    CHECK(std::filesystem::exists(out / "fixtures"));
    const auto replay = [&] { ReplayRecorder(out.path(), scene, {camera, ""}, {}, false).finish(ending); };
    {
        const FileSizeLimit small(2000);
        CHECK_THROWS_AS(replay(), Error);
    }
    CHECK(std::filesystem::exists(out / "arm.csv"));
    replay();
    CHECK(!std::filesystem::exists(out / "arm.csv"));
    CHECK(!std::filesystem::exists(out / "fixtures"));
    CHECK(std::filesystem::exists(out / "summary.json"));
    out.write("arm.csv", "t_s,shoulder\n");
    out.write("fixtures/notes.txt", "mine");
    replay();
    CHECK(out.read("arm.csv") == "t_s,shoulder\n");
    CHECK(out.read("fixtures/notes.txt") == "mine");
}

TEST_CASE(
    "A replay reports targets by their class when an edit adds guidance classes, and when one removes them") {
    const ScratchFolder recording, out;
    const std::vector<std::string> classes{classText("red", "forbidden") + classText("blue", "guidance"),
                                           classText("handle", "guidance") + classText("blue", "guidance"),
                                           classText("handle", "guidance") +
                                               classText("\"(spare 1)\"", "forbidden")};
    std::string edits = std::string(SceneEdits::kHeader) + "\n";
    for (size_t i = 0; i < classes.size(); ++i) {
        const std::string name = "scene-" + std::to_string(i) + ".yaml";
        put(recording.path() / name, "fixtures:\n" + classes[i] + "tool: { spheres: [[0, 0, 0, 0.01]] }\n");
        edits += std::to_string(i) + "," + name + ",,0\n";
    }
    put(recording.path() / SceneEdits::kFile, edits);
    const SceneEdits edited(recording.path());
    const Scene scene = edited.at(0).scene;
    CameraInfo camera;
    camera.depth = {64, 48, 60.0, 60.0, 31.5, 23.5};
    ReplayRecorder recorder(out.path() / "run", scene, {camera, ""}, {}, false, nullptr, "", &edited);
    const std::vector<std::vector<GuidancePose>> poses{
        {seen(1, 50)}, {seen(0, 60), seen(1, 61)}, {seen(0, 70)}};
    HostFixtures set;
    set.camera = camera;
    for (uint32_t image = 0; image < poses.size(); ++image) {
        FrameReport report;
        report.index = image;
        report.counts.classPixels = {100, 100};
        report.counts.classSpheres = report.counts.classPatches = {10, 10};
        set.guidance = poses[image];
        recorder.frame(report, image / 30.0, set, {});
    }
    ReplayRecorder::Ending ending;
    ending.camera = camera;
    ending.lastSet = &set;
    const ReplaySummary summary = recorder.finish(ending);
    REQUIRE(summary.guidance.size() == 2);
    CHECK(summary.guidance[0].name == "handle");
    CHECK(summary.guidance[0].count == 70);
    CHECK(summary.guidance[1].name == "blue");
    CHECK(summary.guidance[1].count == 61);
    REQUIRE(summary.fixtures.size() == 2);
    CHECK(summary.fixtures[0].name == "handle");
    CHECK(summary.fixtures[0].role == "guidance");
    CHECK(summary.fixtures[1].name == "blue");
}
