// SPDX-License-Identifier: Apache-2.0
// Edits in the tab Fixtures, by mouse and by the editor.
#include "tests/apps/laid_screen.h"

#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::operate;

TEST_CASE("In the image of a camera without colour nothing is picked or selected") {
    testing::LaidScreen laid;
    Console console;
    laid.editor.pickAt(console, laid.run.view.scene(), {3, 3});
    CHECK_FALSE(console.pick.taken);
    console.pick.taken = true;
    laid.editor.preview(console, laid.run.view.scene());
    CHECK(laid.editor.selection().empty());
}
