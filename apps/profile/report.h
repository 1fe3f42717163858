// SPDX-License-Identifier: Apache-2.0
// What `fathom profile` writes: NAME.csv and NAME.png a study, profile.json and report.html over all of them.
#pragma once

#include "apps/profile/study.h"

#include <string>
#include <utility>
#include <vector>

namespace fathom::profile {

// Facts of the run that every figure hangs on: device, driver, host CPU, settings, load. In order.
using Facts = std::vector<std::pair<std::string, std::string>>;
Facts runFacts(const gpu::Device& device, const Settings& settings, const std::string& command);

// Every file appears whole or not at all. Throw Error that names the file.
void writeStudyCsv(const Study& study, const std::filesystem::path& file);
void writeProfileJson(const Facts& facts, const std::vector<Study>& studies,
                      const std::filesystem::path& file);
// Self-contained: the pictures, which lie beside it, are embedded.
void writeReportHtml(const Facts& facts, const std::vector<Study>& studies,
                     const std::filesystem::path& folder);

} // namespace fathom::profile
