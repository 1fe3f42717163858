// SPDX-License-Identifier: Apache-2.0
// `fathom devices`: what is plugged in, what it can do, and why something cannot be used.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <ostream>

namespace fathom {

// Looks at sysfs and at the doors in `doors`; opens nothing but to see whether it may be.
void printHandDevices(std::ostream& out, const std::filesystem::path& root,
                      const std::filesystem::path& doors);

void addDevicesCommand(CLI::App& app);

} // namespace fathom
