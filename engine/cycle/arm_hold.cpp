// SPDX-License-Identifier: Apache-2.0
#include "engine/cycle/arm_hold.h"

namespace fathom {

bool ArmHold::follow(const ArmFollow& status) noexcept {
    connected_ = true;
    follows_ = status.follows;
    return status.known && wasStill_;
}

bool ArmHold::stands(const StepConditions& conditions) noexcept {
    wasStill_ = connected_ && (!follows_ || !conditions.sampleFinite || conditions.off ||
                               !conditions.setReady || conditions.stale);
    return wasStill_;
}

void ArmHold::step(const StepConditions& conditions, bool trapped, StepRecord& out) noexcept {
    const bool wrong = !conditions.sampleFinite || !conditions.setReady || conditions.off ||
                       conditions.stale || trapped || !out.finite || conditions.armStill;
    const bool met = conditions.clutch || connected_ || // a tool that a real arm follows never left it
                     glm::distance(out.tool.position, out.device.position) <= kResumeWithin;
    commandsHold_ = wrong || (commandsHold_ && !met);
    out.armHold = commandsHold_;
}

} // namespace fathom
