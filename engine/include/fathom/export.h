// SPDX-License-Identifier: Apache-2.0
/// @file
/// Symbol visibility and the version of the binary interface. Included by the other headers.
#pragma once

/// Marks what the library exports.
#define FATHOM_API __attribute__((visibility("default")))
/// Marks what stays inside of the library.
#define FATHOM_LOCAL __attribute__((visibility("hidden")))

namespace fathom {
#ifdef FATHOM_BUILDING_LIBRARY
namespace v0 {} // namespace v0
#else
inline namespace v0 {}
#endif
} // namespace fathom
