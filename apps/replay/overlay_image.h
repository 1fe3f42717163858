// SPDX-License-Identifier: Apache-2.0
// overlay.png: the camera's last picture with all that the hand felt in it: regions, guidance, tool, hand,
// force.
#pragma once

#include "apps/replay/tick_record.h"
#include "engine/contact/fixtures.h"
#include "engine/types/camera_info.h"
#include "engine/types/sphere_tree.h"

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace fathom {

// Everything is read during the call only. Poses in the base frame [m].
struct OverlayInput {
    CameraInfo camera;
    Pose baseTcamera;
    std::span<const uint32_t>
        colour; // 0xAABBGGRR, of the size of camera.colour; empty or another size: depth as grey
    std::span<const uint16_t> depth;     // raw units, of the size of camera.depth; empty: a plain ground
    const Fixtures* set = nullptr;       // regions and guidance; null or frame -1: none
    std::vector<std::string> classNames; // rows of Scene::fixtures
    std::span<const Sphere> leaves;      // tool frame [m]
    TickRecord tick;                     // the last one: proxy, hand, wrench, state, guidance
    std::string title;                   // scene and source
};

// Enlarged by a whole factor to at least 960 pixels wide, a caption with legend below. Regions: translucent
// red, hatched, outlined (held ones hatched the other way and dashed); guidance: blue cross, disc and normal;
// tool: solid outline; hand: dashed; force: amber arrow. Time grows with the spheres' height in pixels: 60 k
// spheres of 100 pixels take well under a second. Throws Error that names the file.
void writeOverlay(const std::filesystem::path& file, const OverlayInput& input);

} // namespace fathom
