// SPDX-License-Identifier: Apache-2.0
/// @file
/// The whole public interface of the library.
#pragma once

#include <fathom/camera.h>   // IWYU pragma: export
#include <fathom/engine.h>   // IWYU pragma: export
#include <fathom/error.h>    // IWYU pragma: export
#include <fathom/hand.h>     // IWYU pragma: export
#include <fathom/lockstep.h> // IWYU pragma: export
#include <fathom/scene.h>    // IWYU pragma: export
#include <fathom/types.h>    // IWYU pragma: export
