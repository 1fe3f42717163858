// SPDX-License-Identifier: Apache-2.0
// Names for screenshots, recordings and exports.
#include "apps/operate/unused_name.h"
#include "tests/support/scratch_folder.h"

#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::operate;
using namespace fathom::testing;

TEST_CASE("A result takes the first number that no earlier session has used, with any of its endings") {
    const ScratchFolder scratch;
    CHECK(unusedName(scratch.path() / "missing", "export", {""}).filename() == "export-1");
    put(scratch.path() / "shot-1.png", "");
    std::filesystem::create_symlink("nowhere", scratch.path() / "shot-2.png");
    put(scratch.path() / "shot-4.png", "");
    CHECK(unusedName(scratch.path(), "shot", {".png"}) == scratch.path() / "shot-3");
    CHECK(unusedName(scratch.path(), "shot", {".txt"}) == scratch.path() / "shot-1");
    put(scratch.path() / "shot-3.mp4", "");
    CHECK(unusedName(scratch.path(), "shot", {".png", ".mp4"}) == scratch.path() / "shot-5");
}
