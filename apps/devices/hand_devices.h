// SPDX-License-Identifier: Apache-2.0
// Cameras, hands, arms and doors that are plugged in, what they can do, and why something cannot be used.
#pragma once

#include <filesystem>
#include <ostream>

namespace fathom {

// Looks at sysfs and at the doors in `doors`; opens nothing but to see whether it may be.
void printHandDevices(std::ostream& out, const std::filesystem::path& root,
                      const std::filesystem::path& endpoints);

} // namespace fathom
