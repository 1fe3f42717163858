// SPDX-License-Identifier: Apache-2.0
// Adapters to other libraries for comparison in `fathom profile peers`, all behind the same few calls. Each
// library is used in its documented and fastest way; if there are two natural ways, both are here.
#pragma once

#include "engine/contact/host_fixtures.h"
#include "engine/contact/tool.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace fathom::peers {

// Finds the region spheres within reach of a tool: d <= reach + r_t + R for some leaf. For one thread.
class CollisionPeer {
public:
    virtual ~CollisionPeer() = default;

    // Builds from scratch and discards the previous tree. The spheres must outlive the queries. Allocates.
    virtual void build(const RegionSpheres& spheres) = 0;
    // Returns the index of each such sphere once, in any order. Requires build().
    virtual void query(const PosedLeaves& leaves, float reach, std::vector<uint32_t>& found) = 0;
};

// A row-major depth image [m]; NaN = no measurement.
struct DepthImage {
    Intrinsics lens; // pinhole without distortion
    std::span<const float> z;
};

// Smooths a depth image. Called by one thread; may use more threads.
class FilterPeer {
public:
    virtual ~FilterPeer() = default;
    // Converts the image to the library's format. Not timed.
    virtual void load(const DepthImage& image) = 0;
    virtual void run() = 0;
    virtual std::vector<float> depths() const = 0; // [m] row-major, NaN = no depth
};

// Converts a depth image to points in the camera frame. Raw depth in millimetres, 0 = no measurement.
class PointPeer {
public:
    virtual ~PointPeer() = default;
    virtual void load(const Intrinsics& lens, std::span<const uint16_t> millimetres) = 0;
    virtual void run() = 0;
    virtual std::vector<dvec3> points() const = 0; // [m] row-major, z is NaN = no point
};

template <class Peer>
struct PeerMethod {
    std::string name;     // library, version, method
    uint32_t threads = 1; // threads that share the work
    std::function<std::unique_ptr<Peer>()> make;
};
std::vector<PeerMethod<CollisionPeer>> collisionMethods();
// Gaussian with sigmas of `pixels` in the image and `metres` in depth; window of 2 radius + 1 pixels if the
// library has one.
std::vector<PeerMethod<FilterPeer>> filterMethods(uint32_t radius, double pixels, double metres);
std::vector<PeerMethod<PointPeer>> pointMethods();

// One file per function.
std::unique_ptr<CollisionPeer> makePclRadius();
std::unique_ptr<CollisionPeer> makeEmbreePoints(uint32_t threads);
std::unique_ptr<CollisionPeer> makeFclTree();
// topDown: rebuilds the tree top-down after the insertions, for faster queries; otherwise keeps it as
// inserted, as Bullet's broad phase does.
std::unique_ptr<CollisionPeer> makeBulletTree(bool topDown);
std::unique_ptr<FilterPeer> makeOpencvBilateral(uint32_t radius, double pixels, double metres,
                                                uint32_t threads);
std::unique_ptr<FilterPeer> makePclBilateral(double pixels, double metres, uint32_t threads);
std::unique_ptr<PointPeer> makeOpencvPoints(uint32_t threads);

} // namespace fathom::peers
