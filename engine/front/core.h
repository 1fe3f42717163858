// SPDX-License-Identifier: Apache-2.0
// The parts of Engine and Lockstep: scene, tool, haptic options, and the device with its cycles.
#pragma once

#include "engine/contact/shapes.h"
#include "engine/cycle/device_cycles.h"
#include "engine/cycle/haptic_cycle.h"
#include "engine/front/public.h"

#include <memory>

namespace fathom::v0 {

struct Scene::Data {
    fathom::Scene scene;
};

} // namespace fathom::v0

namespace fathom::front {

// Data for the haptic thread. Immutable after construction.
struct HapticSide {
    explicit HapticSide(const fathom::Scene& from);
    std::unique_ptr<HapticCycle> cycle(const v0::HandStart& start) const;

    fathom::Scene scene;
    Tool tool;
    std::vector<Shape> shapes;
    HapticOptions options;
};

// Data for the frame and contact threads. `haptic` must outlive it.
struct ComputeSide {
    ComputeSide(const HapticSide& haptic, const v0::CameraModel& camera, const std::string& device);

    std::unique_ptr<gpu::Instance> instance; // null: the scene has no passes
    DeviceCycles cycles;
};

// Throws v0::BadInput for the parts of a scene that the library does not support.
void requireSupported(const fathom::Scene& scene);

} // namespace fathom::front
