// SPDX-License-Identifier: Apache-2.0
// The image of the 3D view: the point cloud, and the translucent surface of the regions, from any side.
#pragma once

#include "apps/operate/console.h"
#include "apps/operate/snapshots.h"
#include "apps/output/image_view.h"

#include <span>
#include <vector>

namespace fathom::operate {

// What the image shows, and how large it is.
struct SpaceView {
    Orbit orbit;
    double floor = 0.0; // [m] base y of the grid
    uint32_t width = 0, height = 0;
    int treeLevel = -1; // -1: no bounds
};

// Rendered on the CPU: points with a depth test; regions as the front of their spheres, blended where they
// are in front of the points. With very many spheres every n-th is drawn, which bounds the time per frame.
class SpaceViewImage {
public:
    void compose(const SceneSnapshot& scene, const SpaceView& view, std::span<const Sphere> arm);

    const std::vector<uint32_t>& pixels() const { return pixels_; } // 0xAABBGGRR
    const ImageView& view() const { return view_; }
    double depthAt(glm::dvec2 pixel) const; // [m] along the eye's axis of points and arm; 0 = nothing there
    // Bounding spheres of blocks of 4x4, 16x16, ... pixels at the chosen level (base frame [m]).
    const std::vector<Sphere>& bounds() const { return bounds_; }

private:
    void clear();
    void drawGrid(const SpaceView& view);
    void drawLine(const dvec3& from, const dvec3& to, uint32_t colour);
    void splatPoints(const SceneSnapshot& scene);
    void putPoint(size_t first, float z, uint32_t colour);
    void splatArm(std::span<const Sphere> arm);
    void splatRegions(const HostFixtures& set);
    void shadeRegions();
    void boundBlocks(const HostFixtures& set, int level);

    ImageView view_;
    std::vector<uint32_t> pixels_;
    std::vector<float> depth_, front_, facing_;
    std::vector<Sphere> bounds_;
};

} // namespace fathom::operate
