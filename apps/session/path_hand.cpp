// SPDX-License-Identifier: Apache-2.0
#include "apps/session/path_hand.h"

#include "devices/simulated/simulated_hand.h"

#include <algorithm>
#include <cmath>

namespace fathom {

namespace {

constexpr double kClosedWithin = 1e-3; // [m]

} // namespace

PathHand::PathHand(HandPath path)
    : path_(std::move(path))
    , closed_(path_.duration() > 0.0 &&
              glm::distance(path_.waypoints().front().deviceThandle.position,
                            path_.waypoints().back().deviceThandle.position) < kClosedWithin) {}

HandSample PathHand::read(double t) noexcept {
    return path_.at(closed_ ? std::fmod(std::max(0.0, t), path_.duration()) : t);
}

std::unique_ptr<HapticDevice> openPathHand(const HandPath& path, const Scene& scene, bool feels) {
    if (!feels) {
        return std::make_unique<ScriptedHand>(path);
    }
    SimulatedHandOptions loop;
    loop.loop = scene.hand.loop;
    loop.delayTicks = scene.haptics.delay;
    return std::make_unique<SimulatedHand>(path, loop);
}

} // namespace fathom
