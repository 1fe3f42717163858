// SPDX-License-Identifier: Apache-2.0
// The recordings that the window offers to open.
#include "apps/operate/open_card.h"

#include "engine/types/error.h"
#include "tests/support/refusal.h"
#include "tests/support/scratch_folder.h"

#include <doctest/doctest.h>
#include <fstream>

using namespace fathom;
using namespace fathom::operate;
using namespace fathom::testing;

TEST_CASE("A recording that was chosen opens when the pilot has closed the window, not after a signal or the "
          "time") {
    Console console;
    console.openCard.next = "recording-1";
    console.closing.stage = ClosingStage::Asks;
    CHECK(opensNext(console, false) == ""); // ended by --seconds while the question is shown
    CHECK(opensNext(console, true) == "");
    console.closing.quit = true;
    CHECK(opensNext(console, false) == "recording-1");
    CHECK(opensNext(console, true) == "");
}

TEST_CASE(
    "Recordings with their scene are listed, the newest first; a folder that cannot be read is one line") {
    const ScratchFolder scratch;
    int age = 0;
    for (const auto& [name, file] : {std::pair("old", "associations.txt"), std::pair("new", "depth.txt"),
                                     std::pair("other", "notes.txt")}) {
        const auto folder = scratch.path() / name;
        std::filesystem::create_directory(folder);
        std::ofstream(folder / "scene.yaml") << "";
        std::ofstream(folder / file) << "";
        std::filesystem::last_write_time(folder, std::filesystem::file_time_type::clock::now() +
                                                     std::chrono::hours(++age));
    }
    CHECK(recordingsIn(scratch.path()) ==
          std::vector<std::string>{(scratch.path() / "new").string(), (scratch.path() / "old").string()});
    CHECK(refusalOf<Error>([&] { recordingsIn(scratch.path() / "missing"); }) ==
          (scratch.path() / "missing").string() + ": cannot be read (No such file or directory)");
}
