// SPDX-License-Identifier: Apache-2.0
/// @file
/// The haptic device: its pose in, the wrench out, once per tick of your 1 kHz loop.
#pragma once

#include <fathom/arm.h>
#include <fathom/types.h>

#include <memory>

namespace fathom::v0 {

/// Bits of Hand::buttons.
enum Button : std::uint32_t {
    Guidance = 1,    ///< pulls the tool towards the guidance target
    DeadManOpen = 2, ///< no force
    Clutch = 4       ///< moves the hand without the tool (the bit is set in the scene)
};

/// One sample of the haptic device.
struct Hand {
    Pose deviceThandle;        ///< raw pose of the handle in the device's frame
    std::uint32_t buttons = 0; ///< bits of Button that are down
};

/// What the forces do.
enum class State {
    Off,     ///< no fixtures yet, or forces are off: the wrench is zero
    Free,    ///< nothing pushes
    Contact, ///< at least one fixture pushes
    Escape,  ///< new fixtures cover the tool; it moves out
    Trapped, ///< no motion obeys every fixture: the tool is held and the force ramps out
    Fading,  ///< the scene is too old, or forces were switched off: the force ramps out
    Waiting  ///< nothing pushes, and the tool lags behind the hand (late contact answers): no force
};

/// Bits of Step::warnings.
enum Warning : std::uint32_t {
    NoScene = 1,       ///< no fixture set yet
    OldScene = 2,      ///< the newest frame is too old: forces fade
    LostDevice = 4,    ///< the compute device is lost; the engine opens it again
    NotFinite = 8,     ///< the hand sample or a result is not finite: the wrench is zero
    TimeBack = 16,     ///< `now` is before the last step; the last time was used
    Stalled = 32,      ///< contact answers are late: the tool moved less than the hand
    EngineFailed = 64, ///< a thread of the engine ended; Engine::failure() says why
    ArmStill = 128     ///< the real arm is silent or not ready: the tool stands still, without force
};

/// A contact that pushed in the last solve. Base frame.
struct Contact {
    Vec3 point{};              ///< [m] on the tool's surface
    Vec3 normal{};             ///< unit, out of the fixture
    double gap = 0.0;          ///< [m]
    std::uint32_t fixture = 0; ///< index into the scene's fixtures
};

/// The result of one step.
struct Step {
    Wrench wrench;    ///< for the device: device axes, about the handle, zero on axes that the scene's device
                      ///< does not drive
    Wrench residual;  ///< for a display: what the device cannot render. Base axes, about the tool
    ArmPosture arm;   ///< the scene's arm; zeros without one
    Pose baseTtool;   ///< the tool, which never enters a forbidden region
    Pose baseTdevice; ///< where the hand commands the tool
    State state = State::Off;       ///< what the forces do
    std::uint32_t warnings = 0;     ///< bits of Warning
    double sceneAge = 0.0;          ///< [s] of the newest frame; NaN before the first
    double minGap = 0.0;            ///< [m] smallest gap to a forbidden region; NaN if unknown
    double clearance = 0.0;         ///< [m] smallest gap to the regions of points at any distance, where the
                                    ///< tool was some 10 ms before; infinity without regions; NaN if unknown
    double guidance = 0.0;          ///< weight of the guidance, 0..1
    std::int64_t frame = -1;        ///< number of the frame behind the active fixtures; -1 = none
    std::uint32_t contactCount = 0; ///< entries of `contacts` that are valid
    std::array<Contact, 8> contacts{}; ///< the first `contactCount` are valid
};

/// Where hand and tool are at the start.
struct HandStart {
    Pose deviceThandle;              ///< the handle's pose now
    const Pose* baseTtool = nullptr; ///< where the tool starts; null = where the hand commands it.
                                     ///< An arm's tip starts where the scene says; a pose here makes the
                                     ///< hand's motion begin there
};

/// Computes the forces. Use it from one thread, the haptic thread. It may outlive its engine: the scene then
/// ages and the forces fade.
class FATHOM_API HandPort {
public:
    /// One step at time `now`. Never allocates, locks, waits or throws. Sets the floating-point mode (MXCSR)
    /// that the engine needs and restores yours.
    Step step(const Hand& hand, Nanoseconds now) noexcept;

    double period() const noexcept; ///< [s] between steps that the scene asks for

    HandPort(HandPort&&) noexcept;            ///< leaves the other one unusable
    HandPort& operator=(HandPort&&) noexcept; ///< leaves the other one unusable
    ~HandPort();

    struct FATHOM_LOCAL Impl;
    explicit HandPort(std::unique_ptr<Impl> impl) noexcept; ///< for the library itself

private:
    std::unique_ptr<Impl> impl_;
};

} // namespace fathom::v0
