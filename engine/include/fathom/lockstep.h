// SPDX-License-Identifier: Apache-2.0
/// @file
/// The same computation on one thread without a clock, for tests and offline analysis. Equal input gives
/// equal output to the last bit.
#pragma once

#include <fathom/engine.h>

namespace fathom::v0 {

/// How long one frame took [s].
struct FrameTimes {
    double upload = 0.0;    ///< copy of the images to the compute device
    double compute = 0.0;   ///< from submission until the compute device has finished
    double published = 0.0; ///< from the start until steps can use the set; includes the two before
};

/// Use it from one thread. Times are yours: any steady sequence that frames and steps share. After fork()
/// only the parent may use it: in the child its destructor does nothing.
class FATHOM_API Lockstep {
public:
    /// EngineOptions::measuredArm must be false: an arm follows the tool exactly.
    /// @throws BadInput, ComputeDeviceLost, Error
    Lockstep(const Scene& scene, const CameraModel& camera, const HandStart& start,
             const EngineOptions& options = {});
    ~Lockstep();
    Lockstep(const Lockstep&) = delete;
    Lockstep& operator=(const Lockstep&) = delete;

    /// Computes the fixture set of a frame and makes it the newest. The stamp is compared with `now` of
    /// step() only: it may be 0, and unlike submit() the order is not checked. Returns how long it took.
    /// @throws ComputeDeviceLost, Error; BadInput for a missing image or pose
    FrameTimes process(const Frame& frame);

    /// Copies the regions of the newest frame into `out` and reuses its memory. False, and `out` unchanged,
    /// before the first frame. Throws std::bad_alloc only.
    bool regions(Regions& out) const;

    /// Answers one contact query at the current tool pose. Steps may use the answer after `contact.delay` (a
    /// key of the scene) further calls of queryContacts(). False before the first frame. @throws Error, for
    /// example when memory is exhausted
    bool queryContacts();

    /// As Engine::clearances(), for the frame of the last process(). @throws Error, for example when memory
    /// is exhausted
    void clearances(std::span<const Pose> baseTtool, Clearances& out);

    /// One haptic step at `now`, which must not go back: the last time is used then, and
    /// StepWarning::TimeBack set.
    Step step(const Hand& hand, Nanoseconds now) noexcept;

    /// No frame will follow: the last one does not age.
    void endFrames() noexcept;

    double period() const noexcept; ///< [s] between steps that the scene asks for

private:
    struct FATHOM_LOCAL Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace fathom::v0
