// SPDX-License-Identifier: Apache-2.0
// Stamps of messages.
#pragma once

#include <cstdint>

namespace fathom {

// [ns] of a stamp [s]. Throws BadInput for one that ROS does not hold: below 0 or from 2^31 s on.
uint64_t messageTime(double stamp);

} // namespace fathom
