// SPDX-License-Identifier: Apache-2.0
#include "engine/haptics/hand_map.h"

#include "engine/types/error.h"
#include "engine/types/number_text.h"

#include <cmath>
#include <string>

namespace fathom {

HandMap::HandMap(const dquat& baseRdevice, double scale)
    : baseRdevice_(baseRdevice)
    , scale_(scale) {
    if (!(scale > 0.0) || !std::isfinite(scale)) {
        throw Error("hand map: scale is " + significant(scale, 6) + " (allowed: a finite number above 0)");
    }
    if (!(std::abs(glm::dot(baseRdevice, baseRdevice) - 1.0) < 1e-6)) {
        throw Error("hand map: base_R_device is not of unit length");
    }
    baseRdevice_ = glm::normalize(baseRdevice);
}

Pose HandMap::map(const Pose& deviceThandle, bool clutch) noexcept {
    if (clutch && started_) {
        clutched_ = true;
        return held_;
    }
    if (clutched_) {
        align(deviceThandle, held_);
    }
    clutched_ = clutch; // one that is down from the start holds the first pose
    started_ = true;
    held_.position = offset_ + scale_ * (baseRdevice_ * deviceThandle.position);
    held_.rotation = glm::normalize(baseRhandle(deviceThandle) * handleRtool_);
    return held_;
}

void HandMap::align(const Pose& deviceThandle, const Pose& pose) noexcept {
    offset_ = pose.position - scale_ * (baseRdevice_ * deviceThandle.position);
    handleRtool_ = glm::normalize(glm::conjugate(baseRhandle(deviceThandle)) * pose.rotation);
    held_ = pose;
}

Wrench HandMap::toDevice(const Wrench& base) const noexcept {
    const dquat deviceRbase = glm::conjugate(baseRdevice_);
    return {deviceRbase * base.force, deviceRbase * base.torque * torqueFactor()};
}

} // namespace fathom
