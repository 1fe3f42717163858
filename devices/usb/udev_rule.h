// SPDX-License-Identifier: Apache-2.0
// What to tell people who may not open a device.
#pragma once

namespace fathom {

// The file ships with the sources.
inline constexpr const char* kUdevRuleFile = "devices/70-fathom.rules";
inline constexpr const char* kUdevRuleHint =
    "a user who may: copy devices/70-fathom.rules to /etc/udev/rules.d, run `udevadm control --reload`, plug "
    "it in anew";
inline constexpr const char* kSerialGroupHint = "a user in the group dialout";

} // namespace fathom
