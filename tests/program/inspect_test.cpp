// SPDX-License-Identifier: Apache-2.0
// `fathom inspect` on folders, and on what cannot be read.
#include "tests/rig/program_refusal.h"

#include <doctest/doctest.h>
#include <fstream>

using namespace fathom;

TEST_CASE("inspect says what a recording folder holds and how to name it, and saves its first frame") {
    const Stage stage;
    stage.recording({Image(kWidth, kHeight, 600), Image(kWidth, kHeight, 600)});
    const std::string folder = (stage / "rec").string();
    const ProgramRun run = runFathom({"inspect", folder, "--out", (stage / "seen").string()});
    CHECK(run.exitCode == 0);
    CHECK(run.err == "");
    for (const std::string& part : {std::string("2 read of 2"), std::string("0.600 m median"),
                                    std::string("64x48"), "--source '" + folder + "'"}) {
        CAPTURE(part);
        CHECK(run.out.find(part) != std::string::npos);
    }
    CHECK(std::filesystem::exists(stage / "seen/depth.png"));
    CHECK(std::filesystem::exists(stage / "seen/colour.png"));
    CHECK(std::filesystem::exists(stage / "seen/histograms.png"));
    CHECK(run.out.find("of the 0.0 % of the pixels") != std::string::npos); // the wall is grey
}

TEST_CASE("inspect says that its source is empty") {
    checkRefusal({"inspect", ""}, {"inspect: SOURCE: empty (allowed: a recording or camera)"});
}

TEST_CASE("inspect's line can be pasted into a shell also for a name with an apostrophe") {
    const Stage stage;
    stage.recording({Image(kWidth, kHeight, 600)});
    std::filesystem::rename(stage / "rec", stage / "it's");
    const ProgramRun run = runFathom({"inspect", (stage / "it's").string()});
    CHECK(run.exitCode == 0);
    CHECK(run.out.find("--source '" + stage.path().string() + "/it'\\''s'\n") != std::string::npos);
}

TEST_CASE("inspect shows the hues of clear colours with their saturation and lightness") {
    const Stage stage;
    Image image(kWidth, kHeight, 600);
    image.paint({0, 0, 32, 48}, kRed).paint({32, 0, 48, 48}, kYellow); // half, and a quarter
    stage.recording({image});
    const ProgramRun run = runFathom({"inspect", (stage / "rec").string()});
    CHECK(run.exitCode == 0);
    CHECK(run.out.find("hue       of the 75.0 % of the pixels") != std::string::npos);
    const size_t red = run.out.find("352.5..  7.5 deg  " + std::string(40, '#')),
                 yellow = run.out.find(" 52.5.. 67.5 deg  " + std::string(20, '#') + " ");
    CHECK(red != std::string::npos);
    CHECK(yellow != std::string::npos);
    CHECK(run.out.find("saturation 0.80..0.82, lightness 0.42..0.44", red) != std::string::npos);
}

TEST_CASE("inspect names each stream once, also where an option has chosen it, and the line can be used") {
    const Stage stage;
    const std::string file = (stage / "rec.mcap").string();
    std::filesystem::copy_file("tests/fuzz/corpus/mcap/zstd", file);
    const auto line = [](const std::string& source) {
        const ProgramRun run = runFathom({"inspect", source});
        CHECK_MESSAGE(run.exitCode == 0, run.err);
        const std::string begin = "use       --source '";
        const size_t at = run.out.find(begin);
        REQUIRE(at != std::string::npos);
        return run.out.substr(at + begin.size(), run.out.find('\'', at + begin.size()) - at - begin.size());
    };
    const std::string whole = line(file), depth = whole.substr(0, whole.find(",colour="));
    CHECK(whole.find(",depth=") != std::string::npos);
    CHECK(line(whole) == whole);
    CHECK(line(depth) == whole);
    CHECK(line(file + ",colour=none").find(",colour=none,depth=") != std::string::npos);
    CHECK(line(line(file + ",colour=none")) == line(file + ",colour=none"));
}

TEST_CASE("An unknown option behind a recording is named with those that exist, and a missing file as such") {
    const Stage stage;
    const std::string file = (stage / "rec.mcap").string();
    std::filesystem::copy_file("tests/fuzz/corpus/mcap/zstd", file);
    checkRefusal({"inspect", file + ",foo=1"}, {"--source", "foo=1: unknown", "colour=", "duration="});
    checkRefusal({"inspect", file + ",foo=1,start=0"}, {"--source", "foo=1: unknown"});
    checkRefusal({"inspect", (stage / "nope.bag").string()}, {"nope.bag: file: missing"});
}

TEST_CASE("inspect rejects what is not a source in one line, after the list of streams where there is one") {
    const Stage stage;
    stage.write("notes.txt", "no recording");
    checkRefusal({"inspect", (stage / "notes.txt").string()}, {"notes.txt", "kind", "MCAP"});
    checkRefusal({"inspect", (stage / "nowhere").string()}, {"nowhere", "missing"});
    checkRefusal({"inspect"}, {"SOURCE"});
}

TEST_CASE("inspect says what is wrong with a folder of ROS 2 once") {
    const Stage stage;
    std::filesystem::create_directory(stage / "rec");
    std::filesystem::copy_file("tests/fuzz/corpus/mcap/zstd", stage / "rec/a_0.mcap");
    std::filesystem::copy_file("tests/fuzz/corpus/mcap/zstd", stage / "rec/b_0.mcap");
    std::ofstream(stage / "rec/metadata.yaml")
        << "rosbag2_bagfile_information: {relative_file_paths: [a_0.mcap, gone_1.mcap]}\n";
    const ProgramRun run = runFathom({"inspect", (stage / "rec").string()});
    CHECK_MESSAGE(run.exitCode == 0, run.err);
    for (const char* warning : {"metadata.yaml lists gone_1.mcap", "does not list it: b_0.mcap"}) {
        CAPTURE(warning);
        const size_t first = run.err.find(warning);
        CHECK(first != std::string::npos);
        CHECK(run.err.find(warning, first + 1) == std::string::npos);
    }
}
