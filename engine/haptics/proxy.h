// SPDX-License-Identifier: Apache-2.0
// The proxy (virtual tool): a pose that follows the hand and never enters a region. Paper V.B.
#pragma once

#include "engine/haptics/constrained_proxy.h"
#include "engine/haptics/tool_kinematics.h"

namespace fathom {

extern template class ConstrainedProxy<ToolKinematics>;

class Proxy : public ConstrainedProxy<ToolKinematics> {
public:
    Proxy(const Tool& tool, std::span<const Shape> shapes, const ProxyOptions& options, const Pose& start);

    ProxyStep step(const ProxyInput& input) noexcept;

    const Pose& pose() const noexcept { return kinematics_.pose(); }
    // Moves the tool without any check: pressed regions vanished. Ignores a pose that is not finite.
    void setPose(const Pose& pose) noexcept { kinematics_.setPose(pose); }
    // The hand map moved the target to `target`: the next step does not count that as motion of the hand.
    void setTarget(const Pose& target) noexcept { kinematics_.setTarget(target); }
};

} // namespace fathom
