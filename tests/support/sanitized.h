// SPDX-License-Identifier: Apache-2.0
// A sanitizer finds in a part of the work what it finds in all of it, and takes ten times as long.
#pragma once

namespace fathom {

#ifdef FATHOM_SANITIZED
inline constexpr bool kSanitized = true;
#else
inline constexpr bool kSanitized = false;
#endif

} // namespace fathom
