// SPDX-License-Identifier: Apache-2.0
// stability.json and stability.md: what every case came to.
#pragma once

#include "apps/stability/stability_run.h"

#include <filesystem>
#include <string>
#include <vector>

namespace fathom::stability {

// What the figures were taken on: the Vulkan device that --device picks and the CPU. Never throws: says so
// when there is none.
std::string deviceDescription(const std::string& selector);

// {"cases":[{"name","group","figure","unit","limit","holds","note"}],"holds","device"}; a figure that is not
// finite is null.
std::string toJson(const std::vector<CaseResult>& results, const std::string& device);

// A table a group, with the way to compare, the time, and the plots that were drawn.
std::string toMarkdown(const std::vector<CaseResult>& results, const std::string& device);

bool allHold(const std::vector<CaseResult>& results);

// Writes both files whole or not at all; throws Error that names the file.
void writeReport(const std::filesystem::path& folder, const std::vector<CaseResult>& results,
                 const std::string& device);

} // namespace fathom::stability
