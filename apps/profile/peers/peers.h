// SPDX-License-Identifier: Apache-2.0
// Libraries of others doing our work, each behind the same few calls: what `fathom profile peers` measures
// beside. Each is used the way its own documentation recommends, as fast as that goes; where two ways are
// natural both are here.
#pragma once

#include "engine/contact/fixtures.h"
#include "engine/contact/tool.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace fathom::peers {

// Which region spheres lie within reach of a tool: d <= reach + r_t + R for some leaf. One thread.
class CollisionPeer {
public:
    virtual ~CollisionPeer() = default;

    // From scratch, whatever was built before. The spheres must outlive the queries. Allocates.
    virtual void build(const RegionSpheres& spheres) = 0;
    // The index of each such sphere once, in any order. Not before build().
    virtual void query(const PosedLeaves& leaves, float reach, std::vector<uint32_t>& found) = 0;
};

// Depth images, row-major [m], not a number = no measurement.
struct DepthImage {
    Intrinsics lens; // without distortion
    std::span<const float> z;
};

// Smooths a image. One thread calls; the work may be spread over more.
class FilterPeer {
public:
    virtual ~FilterPeer() = default;
    // Copies the image into the form that the library takes: not part of what is timed.
    virtual void load(const DepthImage& image) = 0;
    virtual void run() = 0;
    virtual std::vector<float> depths() const = 0; // [m] row-major, not a number = none
};

// Points of a depth image in the camera's frame. Raw depth in millimetres, 0 = no measurement.
class PointPeer {
public:
    virtual ~PointPeer() = default;
    virtual void load(const Intrinsics& lens, std::span<const uint16_t> millimetres) = 0;
    virtual void run() = 0;
    virtual std::vector<dvec3> points() const = 0; // [m] row-major, z not a number = none
};

template <class Peer>
struct Way {
    std::string name;     // library, version, what of it
    uint32_t threads = 1; // that the work is spread over
    std::function<std::unique_ptr<Peer>()> make;
};
std::vector<Way<CollisionPeer>> collisionWays();
// A Gaussian of `pixels` pixels in the image and `metres` in depth; window of 2 radius + 1 pixels where the
// library has one.
std::vector<Way<FilterPeer>> filterWays(uint32_t radius, double pixels, double metres);
std::vector<Way<PointPeer>> pointWays();

// One a file.
std::unique_ptr<CollisionPeer> makePclRadius();
std::unique_ptr<CollisionPeer> makeEmbreePoints(uint32_t threads);
std::unique_ptr<CollisionPeer> makeFclTree();
// topDown: built anew from the top after the insertions, for faster queries; else as inserted, which is what
// its broad phase does.
std::unique_ptr<CollisionPeer> makeBulletTree(bool topDown);
std::unique_ptr<FilterPeer> makeOpencvBilateral(uint32_t radius, double pixels, double metres,
                                                uint32_t threads);
std::unique_ptr<FilterPeer> makePclBilateral(double pixels, double metres, uint32_t threads);
std::unique_ptr<PointPeer> makeOpencvPoints(uint32_t threads);

} // namespace fathom::peers
