// SPDX-License-Identifier: Apache-2.0
#include "apps/binding/raw_path.h"

#include "engine/haptics/hand_map.h"

namespace fathom {

std::vector<HandWaypoint> toHand(std::vector<HandWaypoint> waypoints, const Scene::Hand& hand) {
    const dquat deviceRbase = glm::conjugate(hand.baseRdevice);
    for (HandWaypoint& w : waypoints) {
        w.deviceThandle.position = deviceRbase * w.deviceThandle.position / hand.scale;
        w.deviceThandle.rotation = deviceRbase * w.deviceThandle.rotation;
    }
    return waypoints;
}

Pose startOf(const HandPath& path, const Scene& scene) {
    return HandMap(scene.hand.baseRdevice, scene.hand.scale).map(path.at(0.0).deviceThandle, false);
}

} // namespace fathom
