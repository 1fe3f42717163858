// SPDX-License-Identifier: Apache-2.0
// What the engine's apps know of a camera, live, recorded or simulated.
#pragma once

#include "engine/types/camera_info.h"
#include "engine/types/frame.h"
#include "engine/types/sphere_tree.h"

#include <optional>
#include <span>
#include <string>

namespace fathom {

// One thread calls it. A source that ends (a recording, a scripted scene) returns no frame once and for ever
// after.
class Camera {
public:
    virtual ~Camera() = default;
    virtual const CameraInfo& info() const = 0;
    // Next good frame; blocks until there is one. A bad frame is skipped, counted, named in the log. At most
    // kFramesInFlight leases may be alive at once. Throws DeviceLost when a live camera is gone.
    virtual std::optional<Frame> next() = 0;
    // Frames that were there but unusable, so far.
    virtual uint32_t skipped() const = 0;
    // Whether the pictures come when they come, stamped with CLOCK_MONOTONIC, and not when they are asked
    // for.
    virtual bool live() const { return false; }
    // Live: pictures that never came, or that a newer one overtook, so far.
    virtual uint64_t lost() const { return 0; }
    // Of a simulated one: draws these spheres, base frame [m], from its next picture on. Others draw nothing.
    virtual void showArm(std::span<const Sphere>) {}
    // A recording: how many pictures it has, bad ones included; 0 where one cannot choose. seek() makes
    // `index` the next one that next() looks at; false where that is not possible.
    virtual uint32_t images() const { return 0; }
    virtual bool seek(uint32_t) { return false; }
    // [s] from picture to picture, when the source knows.
    virtual std::optional<double> framePeriod() const { return std::nullopt; }
    // One word and a name, e.g. "recorded FOLDER".
    virtual std::string description() const = 0;

    static constexpr uint32_t kFramesInFlight = 4;
};

} // namespace fathom
