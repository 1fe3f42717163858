// SPDX-License-Identifier: Apache-2.0
// What a pilot sees of a recording that runs and of one that is saved.
#include "devices/recorded/png_image.h"
#include "tests/window/window_rig.h"

#include <cstdlib>
#include <doctest/doctest.h>
#include <filesystem>
#include <fstream>

using namespace fathom;
using namespace fathom::window;
using nlohmann::json;

namespace {

json recorded(const json& s) {
    return s["console"]["recorded"];
}

} // namespace

TEST_CASE(
    "The chip REC shows time, size and what is left on the disk; the saved recording names its folder") {
    WindowRig rig;
    rig.key("r");
    REQUIRE(rig.await([](const json& s) { return recorded(s)["seconds"] > 1.0; }));
    const json s = rig.state();
    CHECK(recorded(s)["bytes"] > 10'000);
    CHECK(recorded(s)["left"] > 1'000'000);
    const auto chip = s["chips"][0].get<std::string>();
    CHECK(chip.find("REC 0:0") == 0);
    CHECK(chip.find("B left") == chip.size() - 6);
    rig.shoot("rec");
    rig.key("r");
    REQUIRE(rig.awaitNotice("saved: "));
    CHECK(rig.state()["console"]["notice"].get<std::string>().find((rig.folder() / "recording-1").string()) !=
          std::string::npos);
    CHECK(rig.state()["chips"].empty());
    closeQuietly(rig);
}

TEST_CASE("L stores the last seconds, without R, as a recording that opens") {
    WindowRig rig;
    REQUIRE(rig.await([](const json& s) { return s["console"]["kept_s"] > 2.0; }));
    rig.push();
    REQUIRE(rig.await([](const json& s) { return s["console"]["kept_s"] > 4.0; }));
    rig.key("l");
    REQUIRE(rig.awaitNotice("saved: "));
    CHECK(rig.state()["console"]["recording"] == false);
    rig.reopen(rig.folder() / "recording-1");
    const json line = rig.state()["console"]["time_line"];
    CHECK(line["pictures"] > 10);
    CHECK(line["duration"] > 1.0);
    rig.key("End");
    REQUIRE(rig.await([](const json& s) { return s["run"]["device"][2] > 0.1; })); // where the hand was
    closeQuietly(rig);
}

TEST_CASE("Exported images have a caption with time and job below the window") {
    WindowRig rig({"--job", "Vessel A", "--job", "Valve 7"});
    const Screenshot two = rig.shoot("caption");
    CHECK(two.width == 1280);
    const auto light = [](int r, int g, int b) { return r > 180 && g > 180 && b > 180; };
    for (const double row : {0.15, 0.4, 0.6, 0.85}) { // four lines
        const double below = two.height - 720.0;
        CHECK(two.share({0.0, 720.0 + (row - 0.1) * below, 300.0, 0.2 * below}, light) > 0.01);
    }
    closeQuietly(rig);
    WindowRig plain;
    CHECK(plain.shoot("caption-plain").height < two.height);
    closeQuietly(plain);
}

TEST_CASE("X exports a recording with captions: PNG files without ffmpeg, a video with it, or why not") {
    const TemporaryFolder programs;
    const std::string path = std::getenv("PATH");
    const auto fake = [&](const std::string& body) {
        programs.write("ffmpeg", "#!/bin/sh\n" + body);
        std::filesystem::permissions(programs.path() / "ffmpeg", std::filesystem::perms::owner_all);
    };
    ::setenv("PATH", (programs.path().string() + ":" + path).c_str(), 1);
    fake("exit 0\n");
    std::filesystem::permissions(programs.path() / "ffmpeg", std::filesystem::perms::owner_read);
    WindowRig rig;
    rig.key("r");
    REQUIRE(rig.await([](const json& s) { return recorded(s)["seconds"] > 0.5; }));
    rig.key("r");
    REQUIRE(rig.awaitNotice("saved: "));
    rig.reopen(rig.folder() / "recording-1");
    const auto images = rig.state()["console"]["time_line"]["pictures"].get<uint32_t>();
    const std::string exported = "exported " + std::to_string(images) + " images";
    const bool installed = std::system("command -v ffmpeg > /dev/null") == 0; // behind the unusable one
    if (!installed) {
        rig.key("x");
        REQUIRE(rig.awaitNotice(exported));
        CHECK(rig.state()["console"]["notice"].get<std::string>().find("no ffmpeg, so PNG files") !=
              std::string::npos);
        const auto first = readPngSize(rig.folder() / "export-1" / "000000.png");
        REQUIRE(first);
        CHECK(first->width == 1280);
        CHECK(first->height > 720);
        const std::filesystem::directory_iterator files(rig.folder() / "export-1");
        CHECK(std::distance(begin(files), end(files)) == images);
    }
    fake("wc -c > " + (programs.path() / "bytes").string() + "\n");
    rig.key("x");
    REQUIRE(rig.awaitNotice(".mp4"));
    CHECK(rig.state()["console"]["notice"].get<std::string>().find(exported) == 0);
    const unsigned long long bytes = std::stoull(programs.read("bytes"));
    CHECK(bytes > 4ull * 1280 * 720 * images);
    CHECK(bytes % (4ull * 1280 * images) == 0); // whole rows, with the caption's
    fake("head -c 100 > /dev/null; exit 1\n");
    rig.key("x");
    REQUIRE(rig.awaitNotice("then: "));
    CHECK(rig.state()["console"]["notice"].get<std::string>().find("ffmpeg has ended") != std::string::npos);
    CHECK(rig.state()["console"]["time_line"]["t"] == 0.0); // as before
    ::setenv("PATH", path.c_str(), 1);
    closeQuietly(rig);
}

TEST_CASE(
    "O opens a recording from the live window and leads back; a damaged one leads back with the reason") {
    WindowRig rig;
    rig.key("o");
    REQUIRE(rig.awaitNotice("no recording in "));
    rig.key("l");
    REQUIRE(rig.awaitNotice("saved: "));
    rig.key("a");
    REQUIRE(rig.await([](const json& s) { return s["console"]["forces"] == true; }));
    const auto lineIsOn = [](bool on) {
        return
            [=](const json& s) { return s["console"]["time_line"]["on"] == on && s["window"]["frames"] > 3; };
    };
    rig.key("o");
    REQUIRE(rig.await([](const json& s) { return s["console"]["choices"].size() == 1; }));
    rig.shoot("open");
    rig.key("Return");
    REQUIRE(rig.await(lineIsOn(true), 60.0));
    std::string firstLine;
    std::ifstream states(rig.folder() / "state.jsonl");
    std::getline(states, firstLine);
    CHECK(json::parse(firstLine)["console"]["time_line"]["on"] == false); // kept from the live run
    rig.findWindow();
    rig.key("o");
    REQUIRE(rig.await(
        [](const json& s) { return s["console"]["places"].contains("open back to the live run"); }));
    CHECK(rig.state()["console"]["choices"].size() == 2);
    rig.click("open back to the live run");
    REQUIRE(rig.await(lineIsOn(false), 60.0));
    CHECK(rig.state()["console"]["forces"] == false);
    rig.findWindow();
    std::ofstream(rig.folder() / "recording-1" / "marks.csv") << "damaged";
    rig.key("o");
    REQUIRE(rig.await([](const json& s) { return s["console"]["choices"].size() == 1; }));
    rig.key("Return");
    REQUIRE(rig.awaitNotice("marks.csv"));
    CHECK(rig.state()["console"]["time_line"]["on"] == false);
    rig.findWindow();
    closeQuietly(rig);
}

TEST_CASE("N marks a moment of a recording, the time line shows it, and keys go from mark to mark") {
    WindowRig rig;
    const auto past = [&](double seconds) {
        return rig.await([=](const json& s) { return recorded(s)["seconds"] > seconds; });
    };
    rig.key("r");
    REQUIRE(past(0.6));
    rig.key("n");
    REQUIRE(rig.awaitNotice("mark 1 is in the recording"));
    REQUIRE(past(1.6));
    rig.key("r");
    REQUIRE(rig.awaitNotice("saved: "));
    rig.reopen(rig.folder() / "recording-1");
    const auto line = [](const json& s) { return s["console"]["time_line"]; };
    REQUIRE(line(rig.state())["marks"].size() == 1);
    const double first = line(rig.state())["marks"][0];
    CHECK(first > 0.05);
    CHECK(first < line(rig.state())["duration"]);
    rig.key("period");
    REQUIRE(rig.await([&](const json& s) { return line(s)["t"] == first; }));
    rig.key("Home");
    rig.key("n"); // at 0 s
    REQUIRE(rig.await([&](const json& s) { return line(s)["marks"].size() == 2; }));
    rig.key("End");
    rig.key("comma");
    REQUIRE(rig.await([&](const json& s) { return line(s)["t"] == first; }));
    const auto strip = rig.place("time line");
    const double x = strip[0] + first / line(rig.state())["duration"].get<double>() * strip[2];
    rig.key("Home");
    REQUIRE(rig.await([&](const json& s) { return line(s)["t"] == 0.0; }));
    const auto white = [](int r, int g, int b) { return r > 140 && g > 140 && b > 140; };
    const Screenshot shot = rig.shoot("marks");
    CHECK(shot.share({x - 2.0, strip[1], 5.0, strip[3]}, white) > 0.15);
    CHECK(shot.share({x + 90.0, strip[1], 3.0, strip[3]}, white) == 0.0);
    rig.reopen(rig.folder() / "recording-1"); // the file has both
    CHECK(line(rig.state())["marks"].size() == 2);
    closeQuietly(rig);
}
