// SPDX-License-Identifier: Apache-2.0
/// @file
/// The engine: frames in from camera threads, forces out to a haptic thread.
#pragma once

#include <fathom/camera.h>
#include <fathom/error.h>
#include <fathom/hand.h>
#include <fathom/scene.h>

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>

namespace fathom::v0 {

enum class LogLevel { Debug, Info, Warning, Error };

/// Receives log lines of the whole process's engines, one line each, from any of their threads but never from
/// step(). Must not throw.
using LogCallback = std::function<void(LogLevel, std::string_view)>;

/// Sets the receiver. Empty: log lines are discarded, which is the default.
FATHOM_API void setLogCallback(LogCallback callback);

struct EngineOptions {
    std::string device; ///< part of a Vulkan device's name, or its index; empty = the best one
};

/// Owns a compute device, a frame thread and a contact thread, and hands out ports. Each port belongs to one
/// thread. Installs no signal handler, locks no memory and changes no environment.
class FATHOM_API Engine {
public:
    /// Opens the device and compiles the passes; takes up to seconds. One camera is supported.
    /// @throws BadInput, DeviceLost, Error
    Engine(const Scene& scene, const CameraModel& camera, const EngineOptions& options = {});
    Engine(const Scene& scene, std::span<const CameraModel> cameras, const EngineOptions& options = {});
    ~Engine();
    Engine(const Engine&) = delete;
    Engine& operator=(const Engine&) = delete;

    /// The camera's port. @throws BadInput if there is none of that index or name
    CameraPort camera(std::size_t index = 0);
    CameraPort camera(std::string_view name);

    /// Opens the hand's port, once per engine. Allocates; call it before the haptic loop. @throws Error if it
    /// is open already, BadInput for a pose that is not finite
    HandPort openHand(const HandStart& start);

    bool deviceLost() const noexcept; ///< it is being opened again. Any thread.
    std::string failure() const;      ///< what ended a thread of the engine; empty = nothing. Any thread.
    std::string deviceName() const;   ///< Any thread.

private:
    struct FATHOM_LOCAL Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace fathom::v0
