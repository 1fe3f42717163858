// SPDX-License-Identifier: Apache-2.0
// Sanitized builds run a part of the work: it finds the same errors, and all of it would take ten times as
// long.
#pragma once

namespace fathom {

#ifdef FATHOM_SANITIZED
inline constexpr bool kSanitized = true;
#else
inline constexpr bool kSanitized = false;
#endif

} // namespace fathom
