// SPDX-License-Identifier: Apache-2.0
#include "engine/run/run_alarms.h"

#include "engine/types/log.h"
#include "engine/types/pose.h"

#include <cmath>
#include <utility>

namespace fathom {

SpellWarning::Event SpellWarning::see(double t, bool on) noexcept {
    if (!on) {
        return std::exchange(warned_, false) ? Event::End : Event::None;
    }
    if (warned_ || t < quietUntil_) {
        return Event::None;
    }
    warned_ = true;
    quietUntil_ = t + kQuiet;
    return Event::Begin;
}

void AgeAlarm::see(const StepRecord& record) {
    const bool stale = isOld(record.sceneAge);
    staleTicks_ += stale ? 1 : 0;
    if (!warns_) {
        return;
    }
    const SpellWarning::Event event = warning_.see(record.t, stale);
    if (event == SpellWarning::Event::Begin) {
        const bool ahead = record.sceneAge < 0.0;
        log::warn("at {:.2f} s the newest frame is {:.0f} ms {}: forces fade", record.t,
                  std::abs(record.sceneAge) * 1e3,
                  ahead ? "ahead of the clock (allowed: stamps of the monotonic clock)" : "old");
    } else if (event == SpellWarning::Event::End) {
        log::warn("at {:.2f} s frames are fresh again", record.t);
    }
}

void NumberAlarm::see(const TickRow& row) {
    if (warning_.see(row.record.t, !row.record.finite) == SpellWarning::Event::Begin) {
        const bool fromHand = !isFinite(row.hand.deviceThandle);
        log::warn("at {:.2f} s {} not finite: no force in such ticks", row.record.t,
                  fromHand ? "the hand's sample is" : "a number of the tick is");
    }
}

} // namespace fathom
