// SPDX-License-Identifier: Apache-2.0
// stability.json and stability.md: the results of all cases.
#pragma once

#include "apps/stability/stability_run.h"

#include <filesystem>
#include <string>
#include <vector>

namespace fathom::stability {

// Describes the machine of the run: the Vulkan device that --device selects, and the CPU. Never throws; the
// text says if there is no device.
std::string deviceDescription(const std::string& selector);

// {"cases":[{"name","group","figure","unit","limit","holds","note"}],"holds","device"}; a non-finite figure
// is null.
std::string toJson(const std::vector<CaseResult>& results, const std::string& device);

// One table per group with comparison and time, and links to the plots.
std::string toMarkdown(const std::vector<CaseResult>& results, const std::string& device);

bool allHold(const std::vector<CaseResult>& results);

// Writes each file completely or not at all. Throws Error that names the file.
void writeReport(const std::filesystem::path& folder, const std::vector<CaseResult>& results,
                 const std::string& device);

} // namespace fathom::stability
