// SPDX-License-Identifier: Apache-2.0
// Output of `fathom profile`: NAME.csv and NAME.png per study, profile.json and report.html for all of them.
#pragma once

#include "apps/profile/study.h"

#include <string>
#include <utility>
#include <vector>

namespace fathom::profile {

// Conditions of the run, in order: version, date, device, driver, host CPU, load and scene settings. Throws
// BadInput for an invalid scene file.
using Facts = std::vector<std::pair<std::string, std::string>>;
Facts runFacts(const gpu::Device& device, const Settings& settings, const std::string& command);

// Duration of the studies [s]: wall time, and CPU time of all threads.
struct RunTime {
    double wall = 0.0, cpu = 0.0;
};

// Each file is written completely or not at all. Throw Error that names the file.
void writeStudyCsv(const Study& study, const std::filesystem::path& file);
void writeProfileJson(const Facts& facts, const std::vector<Study>& studies, const RunTime& time,
                      const std::filesystem::path& file);
// Self-contained: embeds the images from the same folder.
void writeReportHtml(const Facts& facts, const std::vector<Study>& studies,
                     const std::filesystem::path& folder);

} // namespace fathom::profile
