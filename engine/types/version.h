// SPDX-License-Identifier: Apache-2.0
// Which Fathom this is.
#pragma once

namespace fathom {

// Semantic version, "MAJOR.MINOR.PATCH". Any thread.
const char* version() noexcept;

} // namespace fathom
