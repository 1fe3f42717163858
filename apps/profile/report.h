// SPDX-License-Identifier: Apache-2.0
// What `fathom profile` writes: NAME.csv and NAME.png a study, profile.json and report.html over all of them.
#pragma once

#include "apps/profile/study.h"

#include <string>
#include <utility>
#include <vector>

namespace fathom::profile {

// Facts of the run that every figure hangs on: version, date, device, driver, host CPU, load, and the
// settings of the scene. In order. Throws BadInput for the scene file.
using Facts = std::vector<std::pair<std::string, std::string>>;
Facts runFacts(const gpu::Device& device, const Settings& settings, const std::string& command);

// How long the studies took [s]: on the clock, and of all the program's threads on the processors.
struct RunTime {
    double wall = 0.0, cpu = 0.0;
};

// Every file appears whole or not at all. Throw Error that names the file.
void writeStudyCsv(const Study& study, const std::filesystem::path& file);
void writeProfileJson(const Facts& facts, const std::vector<Study>& studies, const RunTime& time,
                      const std::filesystem::path& file);
// Self-contained: the images, which lie beside it, are embedded.
void writeReportHtml(const Facts& facts, const std::vector<Study>& studies,
                     const std::filesystem::path& folder);

} // namespace fathom::profile
