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

std::vector<Way<CollisionPeer>> collisionWays() {
    std::vector<Way<CollisionPeer>> ways;
    for (const uint32_t threads : threadCounts()) { // for the build; queries use the calling thread
        ways.push_back(
            {onThreads("Embree points", threads), threads, [threads] { return makeEmbreePoints(threads); }});
    }
    ways.push_back({"PCL kd-tree", 1, makePclRadius});
    ways.push_back({"FCL tree", 1, makeFclTree});
    ways.push_back({"Bullet inserted", 1, [] { return makeBulletTree(false); }});
    ways.push_back({"Bullet top-down", 1, [] { return makeBulletTree(true); }});
    return ways;
}

std::vector<Way<FilterPeer>> filterWays(uint32_t radius, double pixels, double metres) {
    std::vector<Way<FilterPeer>> ways;
    for (const uint32_t threads : threadCounts()) {
        ways.push_back({onThreads("OpenCV bilateral", threads), threads,
                        [=] { return makeOpencvBilateral(radius, pixels, metres, threads); }});
        ways.push_back({onThreads("PCL bilateral OMP", threads), threads,
                        [=] { return makePclBilateral(pixels, metres, threads); }});
    }
    return ways;
}

std::vector<Way<PointPeer>> pointWays() {
    std::vector<Way<PointPeer>> ways;
    for (const uint32_t threads : threadCounts()) {
        ways.push_back({onThreads("OpenCV depthTo3d", threads), threads,
                        [threads] { return makeOpencvPoints(threads); }});
    }
    return ways;
}

} // namespace fathom::peers
