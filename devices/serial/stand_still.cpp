// SPDX-License-Identifier: Apache-2.0
#include "devices/serial/stand_still.h"

#include "devices/serial/eca_arm.h"

#include <algorithm>

namespace fathom {

StandStill reachStandStill(ReachKind kind) {
    StandStill still{{0}, 0.02}; // a zero ends any packet; the arm drops a truncated one as damaged
    for (uint8_t device : reachDevices(kind)) {
        ReachFrame frame;
        const size_t size = encodeReach(ReachPacket::ofFloat(ReachArm::kVelocity, device, 0.0f), frame);
        still.bytes.insert(still.bytes.end(), frame.begin(),
                           frame.begin() + static_cast<std::ptrdiff_t>(size));
    }
    return still;
}

StandStill ecaStandStill() {
    const EcaBytes hold = encodeEca(std::array<EcaDemand, kEcaJoints>{});
    // One frame length of zeros: they complete a truncated frame without its end byte, and none of them
    // starts a new one.
    StandStill still{std::vector<uint8_t>(2 * hold.size()), EcaOptions{}.period};
    std::copy(hold.rbegin(), hold.rend(), still.bytes.rbegin());
    return still;
}

} // namespace fathom
