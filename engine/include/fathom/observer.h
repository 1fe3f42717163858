// SPDX-License-Identifier: Apache-2.0
/// @file
/// What displays and planners use: copies of the newest protected regions and of the newest step, and
/// distances of the tool to the regions at other poses.
#pragma once

#include <fathom/hand.h>

#include <limits>
#include <memory>
#include <vector>

namespace fathom::v0 {

/// A sphere of a protected region.
struct RegionSphere {
    std::array<float, 3> centre{}; ///< [m] base axes, relative to Regions::origin
    float radius = 0.0f;           ///< [m]
    std::uint32_t fixture = 0;     ///< index into the scene's fixtures
};

/// A guidance target as one frame shows it.
struct GuidanceTarget {
    std::uint32_t fixture = 0; ///< index into the scene's fixtures
    bool present = false;      ///< seen in this frame; else `baseTtool` is meaningless
    Pose baseTtool{};          ///< where the tool is pulled to
};

/// All regions of one frame.
struct Regions {
    std::int64_t frame = -1;               ///< number of the frame; -1 = none
    Nanoseconds stamp = 0;                 ///< of the frame
    Vec3 origin{};                         ///< [m] base frame
    std::vector<RegionSphere> spheres{};   ///< their union is protected
    std::vector<GuidanceTarget> targets{}; ///< one per guidance fixture of the camera's points
};

/// The smallest gap of the tool at one pose, and the pair of spheres that has it. Exact in float64: no other
/// pair of the frame has a smaller gap, on any device. Of equal gaps the region's sphere that comes first in
/// the image counts, then the tool's sphere with the lowest index.
struct Clearance {
    /// [m] between the tool's surface and the region's; negative = they overlap. Infinity: nothing is
    /// protected. NaN: the pose is not finite. All else is meaningless then.
    double gap = std::numeric_limits<double>::infinity();
    std::uint32_t fixture = 0;   ///< of the region: index into the scene's fixtures
    std::uint32_t toolIndex = 0; ///< of the tool's sphere
    Vec3 toolCentre{};           ///< [m] of that sphere, in the tool's frame
    double toolRadius = 0.0;     ///< [m]
    Vec3 regionCentre{};         ///< [m] of the region's sphere, in the base frame
    double regionRadius = 0.0;   ///< [m]
};

/// Answers for one frame.
struct Clearances {
    std::int64_t frame = -1;        ///< number of the frame whose regions they are about; -1 = no frame yet
    Nanoseconds stamp = 0;          ///< of that frame, rounded to a microsecond
    std::vector<Clearance> poses{}; ///< one per pose, in order; empty before the first frame
};

/// One step of the hand.
struct StepSnapshot {
    Step step{};         ///< its result
    Hand hand{};         ///< its input
    Nanoseconds now = 0; ///< its time
};

/// Copies the newest results for a display. Use it from one thread. It may outlive its engine. Neither the
/// engine nor a step ever waits for it: newer results replace those that it did not fetch.
class FATHOM_API ObserverPort {
public:
    /// Copies the regions of the newest frame into `out` and reuses its memory. Returns false and leaves
    /// `out` unchanged if there is no newer frame than at the last call. Throws std::bad_alloc only.
    bool regions(Regions& out);

    /// Copies the newest step. Returns false and leaves `out` unchanged if there is no newer one. Never
    /// allocates or throws.
    bool step(StepSnapshot& out) noexcept;

    ObserverPort(ObserverPort&&) noexcept; ///< a moved-from port may only be destroyed or assigned to
    ObserverPort& operator=(ObserverPort&&) noexcept; ///< likewise
    ~ObserverPort();

    struct FATHOM_LOCAL Impl;
    explicit ObserverPort(std::unique_ptr<Impl> impl) noexcept; ///< for the library itself

private:
    std::unique_ptr<Impl> impl_;
};

} // namespace fathom::v0
