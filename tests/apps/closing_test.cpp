// SPDX-License-Identifier: Apache-2.0
// Closing the window waits for forces to go, but not forever.
#include "apps/operate/closing.h"
#include "tests/apps/laid_screen.h"

#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::operate;

TEST_CASE("Closing waits five seconds for forces that last, however often it is asked for") {
    testing::LaidScreen laid;
    Console& console = laid.run.console;
    console.switches.forces = true;
    stepClosing(console, laid.editor, {true, false, 10.0});
    CHECK_FALSE(console.switches.forces);
    stepClosing(console, laid.editor, {true, false, 14.9});
    CHECK_FALSE(console.closing.quit);
    stepClosing(console, laid.editor, {false, false, 15.1});
    CHECK(console.closing.quit);
    CHECK(console.closing.forcesRemain);
}

TEST_CASE("Closing without edits ends as soon as forces have gone") {
    testing::LaidScreen laid;
    stepClosing(laid.run.console, laid.editor, {true, false, 10.0});
    CHECK_FALSE(laid.run.console.closing.quit);
    stepClosing(laid.run.console, laid.editor, {false, true, 10.1});
    CHECK(laid.run.console.closing.quit);
    CHECK_FALSE(laid.run.console.closing.forcesRemain);
}

TEST_CASE("A window whose forces last asks about unsaved fixtures, and notes when forces have gone") {
    testing::LaidScreen laid;
    Console& console = laid.run.console;
    laid.editor.remove(0);
    stepClosing(console, laid.editor, {true, false, 1.0});
    stepClosing(console, laid.editor, {false, false, 7.0});
    CHECK_FALSE(console.closing.quit);
    CHECK(console.closing.stage == ClosingStage::Asks);
    CHECK(console.closing.forcesRemain);
    laid.loadFontsFor({1280.0f, 720.0f}, 1.0);
    laid.draw();
    stepClosing(console, laid.editor, {false, true, 7.1});
    CHECK(console.closing.stage == ClosingStage::Asks);
    CHECK_FALSE(console.closing.forcesRemain);
}
