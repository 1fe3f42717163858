// SPDX-License-Identifier: Apache-2.0
/// @file
/// The whole public interface of the library.
///
/// @mainpage C++ library
/// fathom::Engine turns the frames of your depth camera into forces for your haptic device. You give it a
/// fathom::Scene and use it through ports, one per thread: fathom::CameraPort, fathom::HandPort,
/// fathom::ArmPort, fathom::ObserverPort. fathom::Lockstep computes the same on one thread, without a clock.
/// For bridges and observers in other processes there is device_socket.h, in C.
///
/// All of it is in the namespace `fathom::v0`; write `fathom::Engine`.
#pragma once

#include <fathom/arm.h>      // IWYU pragma: export
#include <fathom/camera.h>   // IWYU pragma: export
#include <fathom/engine.h>   // IWYU pragma: export
#include <fathom/error.h>    // IWYU pragma: export
#include <fathom/hand.h>     // IWYU pragma: export
#include <fathom/lockstep.h> // IWYU pragma: export
#include <fathom/observer.h> // IWYU pragma: export
#include <fathom/scene.h>    // IWYU pragma: export
#include <fathom/types.h>    // IWYU pragma: export
