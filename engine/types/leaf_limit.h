// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace fathom {

// Most leaves of a tool, and of all links of an arm together.
inline constexpr size_t kMaxToolLeaves = 4096;

} // namespace fathom
