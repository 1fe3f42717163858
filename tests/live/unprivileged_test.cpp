// SPDX-License-Identifier: Apache-2.0
// A run by a user without privileges: no real-time priority and hardly any locked memory.
#include "tests/rig/stage.h"
#include "tests/support/sanitized.h"

#include <doctest/doctest.h>

using namespace fathom;

TEST_CASE("Without permission for priority and locked memory a live run reports it in one line, and runs") {
    Stage stage;
    stage.recording(std::vector<Image>(10, bumpImage()));
    stage.scene({});
    stage.hand({{0.0, {0.0, 0.0, 0.4}}, {1.0, {0.0, 0.0, 0.45}}});
    std::filesystem::permissions(stage.path(), std::filesystem::perms::all);
    RunSetting setting;
    setting.unprivileged = true;
    const ProgramRun run = runFathom(stage.command({"--realtime", "--device", "llvmpipe"}), setting);
    if (run.exitCode == 126) { // the program's folder is private to this user
        MESSAGE("SKIPPED: the program cannot be started as another user here");
        return;
    }
    CAPTURE(run.err);
    CHECK(run.exitCode == 0);
    REQUIRE(run.errorLines().size() == 1);
    for (const char* part :
         {"haptic thread: the system refused ", "real-time priority (Operation not permitted)",
          "locked memory (Cannot allocate memory)", "man fathom, PERMISSIONS"}) {
        const bool silent = kSanitized && std::string(part).starts_with("locked"); // then nothing is locked
        CHECK((run.err.find(part) != std::string::npos || silent));
    }
    CHECK(readReplay(stage / "out", run).ticks.size() > 100);
}
