// SPDX-License-Identifier: Apache-2.0
// Messages for users without permission to open a device.
#pragma once

namespace fathom {

// Part of the source tree.
inline constexpr const char* kUdevRuleFile = "devices/70-fathom.rules";
inline constexpr const char* kUdevRuleHint = "permission: copy devices/70-fathom.rules to /etc/udev/rules.d, "
                                             "run `udevadm control --reload`, plug it in again";
inline constexpr const char* kSerialGroupHint = "a user in the group dialout";

} // namespace fathom
