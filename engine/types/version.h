// SPDX-License-Identifier: Apache-2.0
// Version of the library.
#pragma once

namespace fathom {

// Semantic version, "MAJOR.MINOR.PATCH". Any thread.
const char* version() noexcept;

} // namespace fathom
