// SPDX-License-Identifier: Apache-2.0
/// @file
/// The haptic device: its pose in, the wrench out, once per tick of your 1 kHz loop.
#pragma once

#include <fathom/arm.h>
#include <fathom/types.h>

#include <memory>
#include <optional>

namespace fathom::v0 {

/// Buttons of the haptic device, one bit each. A scene may name other bits for the clutch (`hand.map.clutch`)
/// and for the grasp of an arm (`arm.grasp.button`).
enum class Button : std::uint32_t {
    None = 0,        ///< none is down
    Guidance = 1,    ///< pulls the tool towards the guidance target
    DeadManOpen = 2, ///< no force
    Clutch = 4       ///< moves the hand without the tool; unless `hand.map.clutch` names another bit
};

/// Buttons that are in either set.
constexpr Button operator|(Button a, Button b) noexcept {
    return static_cast<Button>(static_cast<std::uint32_t>(a) | static_cast<std::uint32_t>(b));
}
/// Buttons that are in both sets.
constexpr Button operator&(Button a, Button b) noexcept {
    return static_cast<Button>(static_cast<std::uint32_t>(a) & static_cast<std::uint32_t>(b));
}

/// One sample of the haptic device.
struct Hand {
    Pose deviceThandle{};          ///< raw pose of the handle in the device's frame
    Button buttons = Button::None; ///< those that are down
};

/// What tool and forces do.
enum class State {
    Off,     ///< no fixtures yet, or forces are off (Button::DeadManOpen): the wrench is zero
    Free,    ///< no fixture pushes; a joint's limit of an arm may
    Contact, ///< at least one fixture pushes
    Escape,  ///< new fixtures cover the tool; it moves out
    Trapped, ///< no motion obeys every fixture: the tool is held and the force ramps out
    Fading,  ///< the newest frame is too old, Button::DeadManOpen switched forces off, or pressed regions
             ///< disappeared: the force ramps out
    Waiting  ///< nothing pushes, and the tool lags (late contact answers, slow joints): no force
};

/// The enumerator's name, for messages: "Contact". Any thread.
FATHOM_API const char* name(State state) noexcept;

/// What limits a step, one bit each.
enum class StepWarning : std::uint32_t {
    None = 0,              ///< nothing does
    NoScene = 1,           ///< no fixture set yet, and the scene has fixtures of points
    OldScene = 2,          ///< the newest frame is too old, or as far in the future: forces fade, also those
                           ///< of placed shapes. Before the first frame nothing is old.
    ComputeDeviceLost = 4, ///< the engine opens the compute device again
    NotFinite = 8,         ///< the hand sample or a result is not finite, or over 1000 km away: no wrench
    TimeBack = 16,         ///< `now` is before the last step; the last time was used
    Stalled = 32,          ///< contact answers are late: the tool moved less than the hand
    EngineFailed = 64,     ///< a thread of the engine failed, Engine::failure() says why, or it is destroyed
    ArmStill = 128,        ///< the real arm is silent or not ready: the tool stands still, without force
    OtherClock = 256       ///< `now` is 5 ms ahead of fathom::now() or 0.1 s behind it, which was used
};

/// Warnings that are in either set.
constexpr StepWarning operator|(StepWarning a, StepWarning b) noexcept {
    return static_cast<StepWarning>(static_cast<std::uint32_t>(a) | static_cast<std::uint32_t>(b));
}
/// Warnings that are in both sets.
constexpr StepWarning operator&(StepWarning a, StepWarning b) noexcept {
    return static_cast<StepWarning>(static_cast<std::uint32_t>(a) & static_cast<std::uint32_t>(b));
}

/// The name of the lowest bit that is set, for messages: "OldScene"; "None" if there is none. Any thread.
FATHOM_API const char* name(StepWarning warnings) noexcept;

/// Contact::fixture of the visible surface, which pushes a tool that new frames show behind it.
inline constexpr std::uint32_t kNoFixture = 0xffffffff;

/// A contact that pushed in the last solve. Base frame.
struct Contact {
    Vec3 point{};              ///< [m] on the tool's surface
    Vec3 normal{};             ///< unit, out of the fixture
    double gap = 0.0;          ///< [m]
    std::uint32_t fixture = 0; ///< index into the scene's fixtures, or kNoFixture
};

/// The result of one step.
struct Step {
    /// Force and torque on the hand, for the device: device axes, torque about the handle; zero on axes that
    /// the scene's device does not drive.
    Wrench wrench{};
    Wrench residual{};   ///< for a display: what the device cannot render. Base axes, torque about the tool
    ArmPosture arm{};    ///< the scene's arm; zeros without one
    Pose baseTtool{};    ///< the tool; its own motion never enters a forbidden region
    Pose baseTcommand{}; ///< tool pose that the hand commands, after hand map and clutch
    State state = State::Off;                 ///< what the forces do
    StepWarning warnings = StepWarning::None; ///< what limits them
    /// [s] of the newest frame; NaN before the first. It never jumps up: after CameraPort::clockJumped() it
    /// counts from the newest stamp of all, until a frame has a newer one.
    double sceneAge = 0.0;
    /// [m] Smallest gap to the region spheres of the active contact set; its reach if none is nearer. NaN if
    /// unknown. Placed shapes do not count.
    double minGap = 0.0;
    /// [m] Smallest gap of the tool, with an arm of all links, to the regions of points, at any distance.
    /// Measured by another thread, every 10 ms or more rarely. Infinity without regions; NaN if unknown.
    double clearance = 0.0;
    double guidance = 0.0; ///< weight of the guidance, 0..1
    /// Index of the frame behind the active fixtures: 0 is the first one that passed the checks of submit()
    /// or lend(), and dropped ones count. -1 = none.
    std::int64_t frame = -1;
    std::uint32_t contactCount = 0;    ///< entries of `contacts` that are valid
    std::array<Contact, 8> contacts{}; ///< the first `contactCount` are valid
};

/// Where hand and tool are at the start.
struct HandStart {
    Pose deviceThandle{}; ///< the handle's pose now
    /// Where the tool starts; empty = where the hand commands it. An arm's tip starts where the scene says; a
    /// pose here makes the hand's motion begin there.
    std::optional<Pose> baseTtool = std::nullopt;
};

/// Computes the forces. Use it from one thread, the haptic thread. It may outlive its engine: the forces then
/// fade.
class FATHOM_API HandPort {
public:
    /// One step at time `now`. Never allocates, locks, waits or throws. Sets the floating-point mode (MXCSR)
    /// that the engine needs and restores yours.
    Step step(const Hand& hand, Nanoseconds now) noexcept;

    double period() const noexcept; ///< [s] between steps that the scene asks for

    HandPort(HandPort&&) noexcept;            ///< a moved-from port may only be destroyed or assigned to
    HandPort& operator=(HandPort&&) noexcept; ///< likewise
    ~HandPort();

    struct FATHOM_LOCAL Impl;
    explicit HandPort(std::unique_ptr<Impl> impl) noexcept; ///< for the library itself

private:
    std::unique_ptr<Impl> impl_;
};

} // namespace fathom::v0
