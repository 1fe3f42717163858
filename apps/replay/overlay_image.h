// SPDX-License-Identifier: Apache-2.0
// Draws overlay.png: the last camera image with regions, guidance, tool, hand and force.
#pragma once

#include "apps/output/image.h"
#include "engine/contact/host_fixtures.h"
#include "engine/cycle/step_record.h"
#include "engine/types/camera_info.h"
#include "engine/types/sphere_tree.h"

#include <span>
#include <string>
#include <vector>

namespace fathom {

// Input of drawOverlay(), which reads it only during the call. Poses in the base frame [m].
struct OverlayInput {
    CameraInfo camera;
    Pose baseTcamera;
    // 0xAABBGGRR, size of camera.colour; otherwise the depth is drawn as grey
    std::span<const uint32_t> colour;
    std::span<const uint16_t> depth;     // raw units, size of camera.depth; empty: uniform background
    const HostFixtures* set = nullptr;   // regions and guidance; null or frame -1: none
    std::vector<std::string> classNames; // of Scene::fixtures, in order
    std::span<const Sphere> leaves;      // tool frame [m]
    StepRecord tick;                     // the last one: proxy, hand, wrench, state, guidance
    std::string title;                   // scene and source
};

// Enlarges the image by an integer factor to at least 960 pixels wide, a narrow one less (imageView()), and
// adds a caption with a legend.
// Regions: translucent red with hatch and outline (held regions have the opposite hatch and a dashed
// outline). Guidance: blue cross, disc and normal. Tool: solid outline; hand: dashed; force: amber arrow. The
// time grows with the spheres' height in pixels: 60,000 spheres of 100 pixels take less than a second. Throws
// Error when the camera has no image size.
Image drawOverlay(const OverlayInput& input);

} // namespace fathom
