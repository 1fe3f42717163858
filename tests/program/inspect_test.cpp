// SPDX-License-Identifier: Apache-2.0
// `fathom inspect` on folders, and on what cannot be read.
#include "tests/rig/refusal.h"

#include <doctest/doctest.h>

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
}

TEST_CASE("inspect rejects what is not a source in one line, after the list of streams where there is one") {
    const Stage stage;
    stage.write("notes.txt", "no recording");
    checkRefusal({"inspect", (stage / "notes.txt").string()}, {"notes.txt", "kind", "MCAP"});
    checkRefusal({"inspect", (stage / "nowhere").string()}, {"nowhere", "missing"});
    checkRefusal({"inspect"}, {"source"});
}
