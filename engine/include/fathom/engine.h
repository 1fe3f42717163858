// SPDX-License-Identifier: Apache-2.0
/// @file
/// The engine: frames in from camera threads, forces out to a haptic thread.
#pragma once

#include <fathom/arm.h>
#include <fathom/camera.h>
#include <fathom/error.h>
#include <fathom/hand.h>
#include <fathom/observer.h>
#include <fathom/scene.h>

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>

namespace fathom::v0 {

/// How important a log line is.
enum class LogLevel { Debug, Info, Warning, Error };

/// Receives the log lines of all engines of the process, one line per call. Called from any of their threads,
/// but never from step(). Calls are serialised by a lock: return quickly, and call nothing of this library.
/// Must not throw.
using LogCallback = std::function<void(LogLevel, std::string_view)>;

/// Sets the receiver. Empty: log lines are discarded, which is the default.
FATHOM_API void setLogCallback(LogCallback callback);

/// How an engine runs. The defaults suit most programs.
struct EngineOptions {
    std::string computeDevice{}; ///< part of a Vulkan device's name, or its index; empty = the best one
    /// Path of the program fathom-reader, which reads the scene's URDFs and meshes in a separate process.
    /// Empty = the one installed with the library, or in the library's folder.
    std::string reader{};
    /// A real arm follows the scene's arm. The tool stands still until Engine::openArm() and its first
    /// report.
    bool measuredArm = false;
};

/// Owns a compute device, a frame thread, a contact thread, a clearance thread, and up to 11 publishing
/// workers (`fathom plan`: publishers). Hands out ports; each port belongs to one thread. Its threads block
/// all signals but those of faults and SIGPROF. Installs no signal handler, locks no memory, changes no
/// environment and does not fork; the constructor starts the program fathom-reader for scenes with URDFs or
/// meshes, and keeps compiled pipelines and spheres of links in $XDG_CACHE_HOME/fathom or ~/.cache/fathom.
/// After fork() only the parent may use it: in the child its destructor does nothing.
class FATHOM_API Engine {
public:
    /// Opens the compute device and compiles the passes, if the scene has classes of points; takes up to
    /// seconds.
    /// @throws BadInput, ComputeDeviceLost, Error
    Engine(const Scene& scene, const CameraModel& camera, const EngineOptions& options = {});
    /// For later versions: several cameras. @throws BadInput unless there is exactly one
    Engine(const Scene& scene, std::span<const CameraModel> cameras, const EngineOptions& options = {});
    ~Engine();
    Engine(const Engine&) = delete;
    Engine& operator=(const Engine&) = delete;

    /// The camera's port. @throws BadInput if there is none of that index or name
    CameraPort camera(std::size_t index = 0);
    CameraPort camera(std::string_view name); ///< the same by CameraModel::name

    /// Opens the hand's port, once per engine. Allocates; call it before the haptic loop. @throws Error if it
    /// is open already, BadInput for a pose that is not finite
    HandPort openHand(const HandStart& start);

    /// Opens the port of the real arm, once per engine. @throws BadInput without EngineOptions::measuredArm,
    /// Error if it is open already
    ArmPort openArm();

    /// Opens the port of a display, once per engine. It starts with the regions of the newest frame. @throws
    /// Error if it is open already
    ObserverPort openObserver();

    /// The smallest gap of the scene's tool at each pose, to the regions of the newest frame. Placed shapes
    /// do not count. With an arm only what its last joint carries counts: `tool:` and the last links (unlike
    /// Step::clearance). Reuses the memory of `out`. Any thread but the haptic one; calls of several threads
    /// run one after the other. Blocks until all are answered. If the GPU answers contact queries, it
    /// answers batches too, at most 16384 poses per submission; an answer that outgrows its buffer takes
    /// more. The CPU answers otherwise, and for poses over 20 m from the origin of the regions. No force
    /// waits for it. If the compute device is lost meanwhile, the CPU answers: slower, and still complete.
    /// @throws Error, for example when memory is exhausted
    void clearances(std::span<const Pose> baseTtool, Clearances& out);

    /// True while the engine reopens a lost compute device. Any thread.
    bool computeDeviceLost() const noexcept;
    std::string failure() const; ///< why a thread of the engine ended; empty = none ended. Any thread.
    /// Of the Vulkan device; "none" for a scene without fixtures of points. Any thread.
    std::string computeDeviceName() const;

private:
    struct FATHOM_LOCAL Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace fathom::v0
