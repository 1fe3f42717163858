// SPDX-License-Identifier: Apache-2.0
// Exact depth and lit colour of an analytic scene through a pinhole camera.
#pragma once

#include "devices/simulated/analytic_scene.h"
#include "devices/simulated/tile_lists.h"
#include "engine/types/camera_info.h"

#include <vector>

namespace fathom {

// Effect of water on light over a range r [m]: colour * exp(-attenuation r) + veil (1 - exp(-scatter r)), as
// in the image formation model of underwater vision (Jaffe 1990; Akkaynak and Treibitz 2018), linear light.
struct WaterOptics {
    glm::vec3 attenuation{0.52f, 0.11f, 0.07f}; // [1/m], red first
    glm::vec3 veil{0.010f, 0.085f, 0.115f};     // blue-green backscatter of endless water
    glm::vec3 scatter{0.45f, 0.50f, 0.55f};     // [1/m]
};

// Tabulated every 2 mm, 0..6 m: six exponentials per pixel cost more than the rays.
class Water {
public:
    explicit Water(const WaterOptics& optics = {});
    glm::vec3 seenThrough(const glm::vec3& colour, float range) const noexcept; // linear light; range [m]

private:
    static constexpr size_t kEntries = 3000;
    static constexpr float kEntriesPerMetre = 500.0f;
    struct Step {
        glm::vec3 left, veil; // transmitted fraction; added light
    };
    std::vector<Step> table_;
};

// setView() from one thread, then cast() and colour() from any number of threads.
class RayCaster {
public:
    RayCaster(AnalyticScene scene, bool water);

    // Spheres in front of, among or behind the scene's own solids, scene frame; seen from the next setView()
    // on. They cast no shadows. Their Solid indices follow those of the scene.
    void setVisitors(std::span<const Sphere> spheres);
    void setView(const Pose& sceneTcamera, const Intrinsics& intrinsics);

    // Nearest surface along the ray of a pixel inside the image, -0.5 .. size - 0.5.
    struct PixelHit {
        double depth = 0.0; // [m] along the optical axis; 0 = no surface
        RayHit hit;
        Ray ray;
    };
    PixelHit cast(double u, double v) const noexcept;

    // Linear light, 0 upwards. A lamp above and left of the camera's first pose with shadows, light from
    // above, water.
    glm::vec3 colour(const PixelHit& pixel) const noexcept;

    const AnalyticScene& scene() const { return scene_; }

private:
    RayHit nearest(const dvec3& direction, std::span<const TileLists::Entry> tile,
                   double axisShare) const noexcept;
    float lampReaches(const dvec3& point, size_t own) const noexcept; // 0 or 1
    float brightness(const Solid& solid, const dvec3& point) const noexcept;

    AnalyticScene scene_;
    size_t own_; // solids of the scene itself; then come visitors
    bool water_;
    Water waterModel_;
    dvec3 origin_{0.0}; // [m] of the camera, scene frame
    glm::dmat3 sceneRcamera_{1.0};
    Intrinsics intrinsics_;
    TileLists view_;
    TileLists lampView_; // the scene as the lamp sees it, for shadows
    std::vector<float> texture_;
};

} // namespace fathom
