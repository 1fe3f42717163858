// SPDX-License-Identifier: Apache-2.0
#include "tests/rig/program_refusal.h"

#include <doctest/doctest.h>

namespace fathom {

void checkRefusal(const std::vector<std::string>& arguments, const std::vector<std::string>& parts,
                  int exitCode) {
    const ProgramRun run = runFathom(arguments);
    CAPTURE(run.err);
    CHECK(run.exitCode == exitCode);
    CHECK(run.out == "");
    CHECK(run.errorLines().size() == 1);
    CHECK(run.err.starts_with("fathom: "));
    for (const std::string& part : parts) {
        CAPTURE(part);
        CHECK(run.err.find(part) != std::string::npos);
    }
}

void checkRefused(const Stage& stage, const std::vector<std::string>& parts,
                  const std::vector<std::string>& more) {
    checkRefusal(stage.command(more), parts);
    for (const char* name : {"summary.json", "haptics.csv", "frames.csv"}) {
        CHECK(!std::filesystem::exists(stage / "out" / name));
    }
}

} // namespace fathom
