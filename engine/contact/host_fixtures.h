// SPDX-License-Identifier: Apache-2.0
// Host copy of one fixture set: all results of one frame, in plain memory that outlives the device.
#pragma once

#include "engine/types/camera_info.h"
#include "engine/types/pose.h"

#include <cstdint>
#include <vector>

namespace fathom {

// Region spheres in order of patch (16x16 pixels), then layer (seen, then held), then 4x4 sub-patch, then
// pixel, so equal frames give equal orders. Positions are float32 about HostFixtures::origin. These floats
// define the region for the GPU, the CPU and every check.
struct RegionSpheres {
    std::vector<float> x, y, z;   // [m] base axes, about the origin
    std::vector<float> radius;    // [m]
    std::vector<uint32_t> source; // pixel v * width + u; held: pixels + that; frozen: 2 pixels + that
    std::vector<uint8_t> fixture; // index into Scene::fixtures

    size_t size() const { return x.size(); }
    void resize(size_t n) {
        x.resize(n);
        y.resize(n);
        z.resize(n);
        radius.resize(n);
        source.resize(n);
        fixture.resize(n);
    }
    // Appends a sphere. aboutOrigin, r [m]: rounded to float32.
    void add(const dvec3& aboutOrigin, double r, uint32_t slot, uint8_t row = 0) {
        x.push_back(static_cast<float>(aboutOrigin.x));
        y.push_back(static_cast<float>(aboutOrigin.y));
        z.push_back(static_cast<float>(aboutOrigin.z));
        radius.push_back(static_cast<float>(r));
        source.push_back(slot);
        fixture.push_back(row);
    }
    // The same with its index as source.
    void add(const dvec3& aboutOrigin, double r) { add(aboutOrigin, r, static_cast<uint32_t>(size())); }
    // Overwrites sphere `at` with sphere i of `from`, which may be *this.
    void replace(size_t at, const RegionSpheres& from, size_t i) {
        x[at] = from.x[i];
        y[at] = from.y[i];
        z[at] = from.z[i];
        radius[at] = from.radius[i];
        source[at] = from.source[i];
        fixture[at] = from.fixture[i];
    }
    // Appends sphere i of another set.
    void addFrom(const RegionSpheres& from, size_t i) {
        resize(size() + 1);
        replace(size() - 1, from, i);
    }
};

// Result of one guidance class in one frame. Count and position are of this frame alone. GuidanceEstimates
// settles plane and target over frames.
struct GuidancePose {
    uint32_t fixture = 0; // index into Scene::fixtures
    uint32_t count = 0;   // points in the mean
    bool present = false; // min_count points before trim
    dvec3 position{0.0};  // [m] base frame: mean of the points
    dvec3 normal{0.0};    // unit, base frame, towards the camera; zero when not planar
    bool planar = false;
    bool rollFree = true; // no long axis: the roll about the normal is free
    Pose target;          // base_T_tool: position + standoff, +z along -normal or the scene's orientation
    dvec3 standoff{0.0};  // [m] part of target.position: along the normal, or towards the camera without one
};

struct HostFixtures {
    int64_t frame = -1;       // Frame index; -1 = none
    double captureTime = 0.0; // [s]
    uint64_t generation = 0;  // number of this set; names it in answers and records
    dvec3 origin{0.0};        // [m] base frame: origin of positions

    RegionSpheres spheres;
    std::vector<GuidancePose> guidance; // one per guidance class, in scene order

    // The source frame, used to test whether a leaf is behind a surface (BehindTracker).
    CameraInfo camera;
    Pose baseTcamera;
    std::vector<uint16_t> depth;         // raw units, width x height
    std::vector<uint32_t> forbiddenBits; // one bit per pixel, row-major, 1 = a forbidden class

    bool forbiddenAt(uint32_t u, uint32_t v) const {
        const uint32_t pixel = v * camera.depth.width + u;
        return !forbiddenBits.empty() && (forbiddenBits[pixel / 32] >> (pixel % 32) & 1u) != 0;
    }
};

} // namespace fathom
