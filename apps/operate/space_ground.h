// SPDX-License-Identifier: Apache-2.0
// The 3D view's picture: the cloud as the camera saw it and the surface of the regions, translucent, from any
// side.
#pragma once

#include "apps/operate/console.h"
#include "apps/operate/snapshots.h"
#include "apps/replay/image_view.h"

#include <span>
#include <vector>

namespace fathom::operate {

// Drawn on the CPU: points by depth test, regions as the nearest front of their spheres, blended where they
// lie before the points. Of very many spheres every n-th is drawn, so that a picture costs a bounded time.
class SpaceGround {
public:
    void compose(const SceneSnapshot& scene, const Orbit& orbit, uint32_t width, uint32_t height,
                 int treeLevel, std::span<const Sphere> arm);

    const std::vector<uint32_t>& pixels() const { return pixels_; } // 0xAABBGGRR
    const ImageView& view() const { return view_; }
    // Bounds of 4x4, 16x16, ... pixels of regions at the level asked for: centre (base, [m]) and radius.
    const std::vector<Sphere>& bounds() const { return bounds_; }

private:
    void splatPoints(const SceneSnapshot& scene);
    void splatArm(std::span<const Sphere> arm);
    void splatRegions(const Fixtures& set);
    void shadeRegions();
    void boundBlocks(const Fixtures& set, int level);

    ImageView view_;
    std::vector<uint32_t> pixels_;
    std::vector<float> depth_, front_;
    std::vector<uint8_t> shade_;
    std::vector<Sphere> bounds_;
};

} // namespace fathom::operate
