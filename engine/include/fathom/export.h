// SPDX-License-Identifier: Apache-2.0
/// @file
/// Symbol visibility, and the namespace of all public names. Included by the other headers.
///
/// `v0` stays until version 1.0. Until then each minor version may change the binary interface, and has a
/// soname of its own: `libfathom.so.0.2` for 0.2.
#pragma once

/// Marks what the library exports.
#define FATHOM_API __attribute__((visibility("default")))
/// Marks what stays inside of the library.
#define FATHOM_LOCAL __attribute__((visibility("hidden")))

namespace fathom {
namespace v0 {}
#ifndef FATHOM_BUILDING_LIBRARY
using namespace v0; // not an inline namespace: clang warns where another header reopens it
#endif
} // namespace fathom
