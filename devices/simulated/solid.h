// SPDX-License-Identifier: Apache-2.0
// Coloured solids of the analytic scenes: exact signed distance, exact ray intersection, normal, bounds. All
// float64.
#pragma once

#include "engine/types/pose.h"
#include "engine/types/sphere_tree.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <optional>

namespace fathom {

// Surface: how it looks. Albedo is linear light 0..1.
struct Paint {
    glm::vec3 albedo{0.5f};
    float gloss = 0.0f; // weight of the highlight
    float grime = 0.0f; // 0..1: how much the brightness varies over the surface
};

// What a solid is; the sizes that each kind has are said below.
enum class SolidKind { Sphere, Box, Plane, Capsule, Cylinder, Torus };

// Frames: `scene` is the scene's, `local` the solid's own. Sizes by kind [m]:
//   Sphere   x = radius
//   Box      half edge lengths
//   Plane    half-space z <= 0 of the local frame, no size
//   Capsule  x = radius, z = half length of the segment along local z
//   Cylinder x = radius, z = half length along local z, flat caps
//   Torus    x = rim radius (to the middle of the tube), y = tube radius, axis local z
struct Solid {
    SolidKind kind = SolidKind::Sphere;
    dvec3 position{0.0};         // [m] scene frame
    glm::dmat3 localTscene{1.0}; // rotation only; its transpose turns local into scene axes
    dvec3 size{0.0};
    double bound = HUGE_VAL; // [m] of a ball about position that encloses the solid; infinite for a plane
    Paint paint;
    uint8_t object = 0; // row of AnalyticScene::objects

    dvec3 toLocal(const dvec3& scenePoint) const { return localTscene * (scenePoint - position); }
};

// A ray in scene axes [m].
struct Ray {
    dvec3 origin{0.0};
    dvec3 direction{0.0, 0.0, 1.0}; // unit
};

// Solids of each kind, placed. Scene axes, lengths [m].
Solid sphereAt(const dvec3& centre, double radius, const Paint& paint);
Solid boxAt(const Pose& sceneTbox, const dvec3& halfEdges, const Paint& paint);
Solid planeThrough(const dvec3& point, const dvec3& outwardNormal, const Paint& paint);
Solid capsuleBetween(const dvec3& a, const dvec3& b, double radius, const Paint& paint);
Solid cylinderBetween(const dvec3& a, const dvec3& b, double radius, const Paint& paint);
Solid torusAt(const dvec3& centre, const dvec3& axis, double rim, double tube, const Paint& paint);

// Euclidean distance to the surface, negative inside [m]. Exact for every kind.
double signedDistance(const Solid& solid, const dvec3& scenePoint) noexcept;

// Unit outward normal at a point of the surface, scene axes.
dvec3 surfaceNormal(const Solid& solid, const dvec3& scenePoint) noexcept;

// Distance along the ray to where it first enters the solid [m]; empty when it misses or starts inside. The
// point lies within 1e-10 m of the surface (closed form; the torus by a march on its distance).
std::optional<double> enter(const Solid& solid, const Ray& ray) noexcept;
// The same for many rays from one origin: that origin in the solid's frame, once, and the direction in scene
// axes. Infinity when there is no such point (a plain number: it stays in a register on the way back).
double enterFrom(const Solid& solid, const dvec3& localOrigin, const dvec3& direction) noexcept;

// Spheres whose convex hull encloses the solid, scene frame; count 0 for a plane, which has no bounds.
struct HullSpheres {
    std::array<Sphere, 8> spheres;
    uint32_t count = 0;
};
HullSpheres hullOf(const Solid& solid);

} // namespace fathom
