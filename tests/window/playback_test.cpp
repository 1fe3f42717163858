// SPDX-License-Identifier: Apache-2.0
#include "tests/rig/replay_output.h"
#include "tests/rig/run_fathom.h"
#include "tests/window/felt.h"
#include "tests/window/window_rig.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::window;
using nlohmann::json;

namespace {

// Records two seconds without motion and then a push against the bump. Returns the folder.
std::filesystem::path recordAPush(WindowRig& rig) {
    rig.key("r");
    REQUIRE(rig.await([](const json& s) { return s["console"]["recording"] == true; }));
    rig.key("a");
    REQUIRE(rig.await([](const json& s) { return s["mode"] == "ARMED"; }));
    const auto ticks = rig.state()["run"]["turns"].get<int>();
    REQUIRE(rig.await([&](const json& s) { return s["run"]["turns"] > ticks + 1500; }));
    rig.push();
    REQUIRE(rig.await([](const json& s) { return s["run"]["force_N"] > 1.0; }));
    const auto pushed = rig.state()["run"]["turns"].get<int>();
    REQUIRE(rig.await([&](const json& s) { return s["run"]["turns"] > pushed + 1500; }));
    rig.key("r");
    REQUIRE(rig.awaitNotice("frames recorded"));
    return rig.folder() / "recording-1";
}

// Paints the yellow square red from this frame on.
void paintRedFrom(const std::filesystem::path& folder, uint32_t first) {
    const Image image = bumpImage().paint({4, 16, 14, 30}, kRed);
    std::vector<uint8_t> bytes;
    for (const Paint3& paint : image.colour) {
        bytes.insert(bytes.end(), {paint.r, paint.g, paint.b});
    }
    for (uint32_t i = first;; ++i) {
        char name[32];
        std::snprintf(name, sizeof name, "rgb/%06u.png", i);
        if (!std::filesystem::exists(folder / name)) {
            return;
        }
        writePng(folder / name, image.width, image.height, 8, 2, bytes); // RGB
    }
}

// Drags the marker to a share of the recording.
void dragTo(WindowRig& rig, double share) {
    const double now = rig.state()["console"]["time_line"]["t"].get<double>() /
                       rig.state()["console"]["time_line"]["duration"].get<double>();
    rig.drag("time line", {now, 0.5}, {share, 0.5});
    REQUIRE(rig.await([&](const json& s) {
        const json& line = s["console"]["time_line"];
        return std::abs(line["t"].get<double>() - share * line["duration"].get<double>()) < 0.02 &&
               line["whole_memory"] == true;
    }));
}

// A moment [s] near the end, while the hand pushes, when no tick fades because a busy machine delayed frames.
double freshMoment(const std::vector<Felt>& felt, const std::vector<double>& sceneAges) {
    constexpr double kAbout = 0.06; // [s] on each side, because dragging is not exact
    double stale = felt.back().t;   // the earliest late tick after the moment
    for (size_t i = felt.size(); i-- > 0 && felt[i].force > 1.0;) {
        if (sceneAges[i] > 0.09) {
            stale = felt[i].t;
        } else if (stale - felt[i].t > 2.0 * kAbout) {
            return felt[i].t + kAbout;
        }
    }
    return -1.0;
}

double lineTime(const json& s) {
    return s["console"]["time_line"]["t"];
}

} // namespace

TEST_CASE("Dragging the time line of a recording shows image, regions, tool, hand and force of that moment") {
    WindowRig rig;
    const std::filesystem::path folder = recordAPush(rig);
    const std::vector<Felt> felt = feltIn(folder / "wrench.csv", 1, 7);
    REQUIRE(firstContact(felt) > 0.5);
    const double moment = freshMoment(felt, columnIn(folder / "wrench.csv", 11));
    REQUIRE(moment > 0.5);
    paintRedFrom(folder, static_cast<uint32_t>(moment * 30.0) - 8);
    rig.reopen(folder);
    REQUIRE(rig.state()["console"]["time_line"]["on"] == true);
    CHECK(rig.state()["console"]["time_line"]["pictures"].get<uint32_t>() >=
          static_cast<uint32_t>(felt.back().t * 30.0));

    dragTo(rig, 0.1);
    const json early = rig.state();
    CHECK(early["run"]["contacts"] == 0);
    CHECK(early["run"]["force_N"] == 0.0);
    CHECK(early["console"]["time_line"]["picture"] == static_cast<int>(lineTime(early) * 30.0 + 1e-6));
    const auto square = [&] {
        const auto camera = rig.place("camera");
        return std::array<double, 4>{camera[0] + camera[2] * 5 / 64, camera[1] + camera[3] * 17 / 48,
                                     camera[2] * 8 / 64, camera[3] * 12 / 48};
    };
    CHECK(rig.shoot("playback-early").share(square(), isRed) < 0.3);

    dragTo(rig, moment / rig.state()["console"]["time_line"]["duration"].get<double>());
    const json late = rig.state();
    const auto at = std::lower_bound(felt.begin(), felt.end(), late["run"]["t"].get<double>() - 1e-7,
                                     [](const Felt& f, double t) { return f.t < t; });
    REQUIRE(at != felt.end());
    CHECK(lineTime(late) > at->t - 1e-6); // the last tick before it, however late the next one was
    CHECK((at + 1 == felt.end() || (at + 1)->t > lineTime(late) - 1e-6));
    CHECK(late["run"]["force_N"].get<double>() == doctest::Approx(at->force).epsilon(1e-6));
    CHECK(late["run"]["force_N"] > 1.0);
    CHECK(late["run"]["device"][2].get<double>() > late["run"]["tool"][2].get<double>() + 0.001);
    CHECK(late["mode"] == "LOOK-BACK");
    CHECK(late["chips"][0] == "CONTACT");
    CHECK(late["why"].get<std::string>().find("'red'") != std::string::npos);
    CHECK(late["run"]["spheres"].get<int>() >= early["run"]["spheres"].get<int>() + 100);
    CHECK(rig.shoot("playback").share(square(), isRed) > 0.6);
    const int code = rig.close();
    CHECK_MESSAGE(code == 0, rig.output());
}

TEST_CASE("Keys step a recording by frames and ticks, and play it until it is stopped") {
    WindowRig rig;
    const std::filesystem::path folder = recordAPush(rig);
    rig.reopen(rig.folder() / "scene.yaml", {"--recording", folder.string()});
    const auto image = [](const json& s) { return s["console"]["time_line"]["picture"].get<int>(); };
    const auto atImage = [&](const json& s) {
        return lineTime(s) == doctest::Approx(image(s) / 30.0).epsilon(1e-6);
    };
    for (int i = 1; i <= 3; ++i) {
        rig.key("Right");
        CHECK(rig.await([&](const json& s) { return image(s) == i && atImage(s); }));
    }
    rig.key("Left");
    CHECK(rig.await([&](const json& s) { return image(s) == 2 && atImage(s); }));
    const double before = lineTime(rig.state());
    const std::vector<Felt> felt = feltIn(folder / "wrench.csv", 1, 7);
    const auto next = std::upper_bound(felt.begin(), felt.end(), before + 1e-6,
                                       [](double t, const Felt& f) { return t < f.t; });
    REQUIRE(next != felt.end());
    rig.key("shift+Right"); // a tick, not a frame
    REQUIRE(rig.await([&](const json& s) { return lineTime(s) > before; }));
    CHECK(lineTime(rig.state()) == doctest::Approx(next->t).epsilon(1e-6));
    rig.key("End");
    REQUIRE(rig.await([&](const json& s) { return lineTime(s) == s["console"]["time_line"]["duration"]; }));
    rig.key("Home");
    REQUIRE(rig.await([&](const json& s) { return lineTime(s) == 0.0; }));
    rig.key("space");
    REQUIRE(rig.await(
        [&](const json& s) { return lineTime(s) > 0.3 && s["console"]["time_line"]["playing"] == true; }));
    rig.click("play");
    REQUIRE(rig.await([&](const json& s) { return s["console"]["time_line"]["playing"] == false; }));
    const double stopped = lineTime(rig.state());
    rig.key("Tab"); // the window continues after the end of the recording
    REQUIRE(rig.await([](const json& s) { return s["console"]["large"] == "space"; }));
    CHECK(lineTime(rig.state()) == stopped);
    CHECK(rig.close() == 0);
}

TEST_CASE("A recording that is shown offscreen with a folder ends with a screenshot, as a live scene does") {
    const TemporaryFolder folder;
    const auto recording = folder.path() / "recording", shots = folder.path() / "new" / "shots";
    writeRecording(recording, {bumpImage()});
    folder.write("recording/hand.csv", "t_s,x,y,z,qw,qx,qy,qz,button\n0,0,0,0,1,0,0,0,0\n");
    folder.write("recording/scene.yaml", SceneText{}.text());
    const ProgramRun run = runFathom({"operate", recording.string(), "--offscreen", "640x480", "--seconds",
                                      "1", "--device", "llvmpipe", "--folder", shots.string()});
    REQUIRE_MESSAGE(run.exitCode == 0, run.err);
    CHECK(readImage(shots / "screenshot-1.png").pixels.size() == 640 * 480);
}

TEST_CASE("An input that is not a recording is rejected in one line with exit code 2") {
    const TemporaryFolder folder;
    folder.write("recording/hand.csv", "t_s,x,y,z,qw,qx,qy,qz,button\n");
    const ProgramRun none =
        runFathom({"operate", (folder.path() / "recording").string(), "--offscreen", "640x480"});
    CHECK(none.exitCode == 2);
    REQUIRE(none.errorLines().size() == 1);
    CHECK(none.errorLines()[0].find("scene.yaml") != std::string::npos);
    CHECK(none.errorLines()[0].find("operate SCENE --recording FOLDER") != std::string::npos);
    writeRecording(folder.path() / "recording", {bumpImage()});
    folder.write("recording/hand.csv", "t_s,x,y,z,qw,qx,qy,qz,button\n0,0,0,0,1,0,0,0,0\n");
    folder.write("recording/scene.yaml", SceneText{}.text());
    folder.write("recording/wrench.csv", "t_s,fx,fy,fz,tx,ty,tz,contacts,state\n0,0,0,zero,0,0,0,0,0\n");
    const ProgramRun damaged = runFathom({"operate", (folder.path() / "recording").string(), "--offscreen",
                                          "640x480", "--device", "llvmpipe"});
    CHECK(damaged.exitCode == 2);
    REQUIRE(damaged.errorLines().size() == 1);
    CHECK(damaged.errorLines()[0].find("wrench.csv: line 2, column 4: 'zero'") != std::string::npos);
}
