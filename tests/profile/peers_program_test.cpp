// SPDX-License-Identifier: Apache-2.0
// `fathom profile peers` as a program. Without the other libraries, it fails with a hint on how to build them
// in. With them, all answers must match float64.
#include "apps/profile/studies.h"
#include "tests/profile/quick_run.h"
#include "tests/rig/run_fathom.h"
#include "tests/support/scratch_folder.h"

#include <algorithm>
#include <doctest/doctest.h>
#include <map>
#include <nlohmann/json.hpp>

using namespace fathom;
using fathom::testing::ScratchFolder;
using fathom::testing::startsWith;
using fathom::testing::textOf;

namespace {

bool builtIn() {
    const auto& all = profile::allStudies();
    return std::any_of(all.begin(), all.end(),
                       [](const auto& entry) { return entry.name == std::string("peers"); });
}

} // namespace

TEST_CASE("A build without the other libraries rejects `peers` in one line that says how to build them in") {
    if (builtIn()) {
        MESSAGE("this build has them");
        return;
    }
    const ScratchFolder folder;
    const ProgramRun run = runFathom({"profile", "peers", "--out", (folder.path() / "out").string()});
    CHECK(run.exitCode == 2);
    REQUIRE(run.errorLines().size() == 1);
    CHECK(run.errorLines().front() ==
          "fathom: profile: STUDY: 'peers' is not in this build (allowed: a build with "
          "-DFATHOM_PEERS=ON, which './run peers' makes and runs)");
}

TEST_CASE("Every library matches float64 on every source and has a ratio to Fathom's time") {
    if (!builtIn()) {
        MESSAGE("built without -DFATHOM_PEERS=ON: see ./run peers --test");
        return;
    }
    const ScratchFolder folder;
    const auto out = folder.path() / "out";
    const ProgramRun run =
        runFathom({"--device", "llvmpipe", "profile", "peers", "--quick", "--out", out.string()});
    REQUIRE(run.exitCode == 0);
    CHECK(std::filesystem::file_size(out / "peers.csv") > 1000);
    CHECK(std::filesystem::file_size(out / "peers.png") > 1000);
    const auto report = nlohmann::json::parse(textOf(out / "profile.json"));
    const auto& study = report["studies"][0];
    std::map<std::string, int> answers; // compared answers by the first word of the setting
    for (const auto& row : study["rows"]) {
        const std::string source = row["source"], setting = row["setting"];
        CAPTURE(source);
        CAPTURE(setting);
        CHECK(row["ratio_to_ours"].get<double>() > 0.0);
        CHECK((!row["default"].get<bool>() || row["ratio_to_ours"].get<double>() == 1.0));
        if (startsWith(source, "filter ")) {
            CHECK(row["rms_from_truth_mm"].get<double>() < 1.0);
            CHECK(row["rms_from_ours_mm"].get<double>() < 1.0);
        } else {
            CHECK(row["error"].get<double>() == 0.0);
            ++answers[setting.substr(0, setting.find(' '))];
        }
        if (startsWith(source, "contact ") &&
            setting != "Fathom CPU whole answer") { // its spheres come from the grid
            CHECK(row["found_mean"].get<double>() > 0.0);
        }
    }
    CHECK(study["no_default"].is_null());
    CHECK(study["defaults"].size() >= 6); // one pass or grid per source
    for (const char* library : {"Fathom", "OpenCV", "PCL", "Embree", "FCL", "Bullet"}) {
        CHECK_MESSAGE(answers[library] > 0, library);
    }
}
