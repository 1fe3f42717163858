// SPDX-License-Identifier: Apache-2.0
// One quick run of `fathom profile`, shared by all cases that check its output.
#pragma once

#include "apps/profile/studies.h"
#include "tests/rig/run_fathom.h"
#include "tests/support/scratch_folder.h"

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>
#include <sstream>

namespace fathom::testing {

struct QuickRun {
    ScratchFolder folder;
    ProgramRun program;
    nlohmann::json report;
    QuickRun() {
        const std::string out = (folder.path() / "out").string();
        RunSetting setting;
        setting.timeLimit = 900.0; // [s] beside other suites on a slow machine; its own time is another case
        program = runFathom({"--device", "llvmpipe", "--trace", (folder.path() / "trace.json").string(),
                             "profile", "--quick", "--out", out},
                            setting);
        report = nlohmann::json::parse(textOf(folder.path() / "out" / "profile.json"), nullptr, false);
    }
    const nlohmann::json& study(const std::string& name) const {
        for (const auto& s : report["studies"]) {
            if (s["name"] == name) {
                return s;
            }
        }
        FAIL("no study " << name);
        return report;
    }
};

inline const QuickRun& quickRun() { // shared by all cases
    static const QuickRun kRun;
    return kRun;
}

inline std::vector<std::vector<std::string>> tableOf(const std::filesystem::path& file) {
    std::vector<std::vector<std::string>> rows;
    std::istringstream in(textOf(file));
    for (std::string line; std::getline(in, line);) {
        auto& row = rows.emplace_back();
        std::istringstream cells(line);
        for (std::string cell; std::getline(cells, cell, ',');) {
            row.push_back(cell);
        }
    }
    return rows;
}

inline bool startsWith(const std::string& text, const std::string& head) {
    return text.starts_with(head);
}

} // namespace fathom::testing
