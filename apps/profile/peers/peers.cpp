// SPDX-License-Identifier: Apache-2.0
#include "apps/profile/peers/peers.h"
#include "engine/types/processors.h"

namespace fathom::peers {

namespace {

// One thread, and all threads of a machine with several.
std::vector<uint32_t> threadCounts() {
    const uint32_t all = usableProcessors();
    return all > 1 ? std::vector<uint32_t>{1, all} : std::vector<uint32_t>{1};
}

std::string onThreads(const std::string& name, uint32_t threads) {
    return threads == 1 ? name : name + " " + std::to_string(threads).append("T");
}

} // namespace

std::vector<PeerMethod<CollisionPeer>> collisionMethods() {
    std::vector<PeerMethod<CollisionPeer>> methods;
    for (const uint32_t threads : threadCounts()) { // for the build; queries use the calling thread
        methods.push_back(
            {onThreads("Embree points", threads), threads, [threads] { return makeEmbreePoints(threads); }});
    }
    methods.push_back({"PCL kd-tree", 1, makePclRadius});
    methods.push_back({"FCL tree", 1, makeFclTree});
    methods.push_back({"Bullet inserted", 1, [] { return makeBulletTree(false); }});
    methods.push_back({"Bullet top-down", 1, [] { return makeBulletTree(true); }});
    return methods;
}

std::vector<PeerMethod<FilterPeer>> filterMethods(uint32_t radius, double pixels, double metres) {
    std::vector<PeerMethod<FilterPeer>> methods;
    for (const uint32_t threads : threadCounts()) {
        methods.push_back({onThreads("OpenCV bilateral", threads), threads,
                           [=] { return makeOpencvBilateral(radius, pixels, metres, threads); }});
        methods.push_back({onThreads("PCL bilateral OMP", threads), threads,
                           [=] { return makePclBilateral(pixels, metres, threads); }});
    }
    return methods;
}

std::vector<PeerMethod<PointPeer>> pointMethods() {
    std::vector<PeerMethod<PointPeer>> methods;
    for (const uint32_t threads : threadCounts()) {
        methods.push_back({onThreads("OpenCV depthTo3d", threads), threads,
                           [threads] { return makeOpencvPoints(threads); }});
    }
    return methods;
}

} // namespace fathom::peers
