// SPDX-License-Identifier: Apache-2.0
// Lists attached cameras, haptic devices, arms and device sockets, with their capabilities and the reason
// when one cannot be used.
#pragma once

#include <filesystem>
#include <ostream>

namespace fathom {

// Reads sysfs and the sockets in the folder `endpoints`; opens a device only to test permission.
void printHandDevices(std::ostream& out, const std::filesystem::path& root,
                      const std::filesystem::path& endpoints);

} // namespace fathom
