// SPDX-License-Identifier: Apache-2.0
// When the alarms of a run warn, with made-up ticks every 10 ms.
#include "engine/run/run_alarms.h"

#include <doctest/doctest.h>
#include <limits>
#include <string>

#include "tests/realtime/listening.h"

using namespace fathom;
using fathom::testing::Listening;

namespace {

// Spells of 0.2 s, of 0.5 s within the quiet time of the first warning, and from within it to 9 s.
bool inSpell(int tick) {
    return (tick >= 100 && tick < 120) || (tick >= 200 && tick < 250) || (tick >= 400 && tick < 900);
}

constexpr int kTicks = 1000;

} // namespace

TEST_CASE("A stall that begins within the quiet time of the last warning is reported when that time is over, "
          "and a shorter one is only counted") {
    for (const bool warns : {true, false}) {
        CAPTURE(warns);
        const Listening log;
        AgeAlarm alarm(warns);
        for (int tick = 0; tick < kTicks; ++tick) {
            StepRecord record;
            record.t = 0.01 * tick;
            record.sceneAge = inSpell(tick) ? 0.2 : 0.03;
            alarm.see(record);
        }
        CHECK(alarm.staleTicks() == 570);
        CHECK(log.count("ms old: forces fade") == (warns ? 2 : 0));
        CHECK(log.count("at 1.00 s the newest frame is 200 ms old: forces fade") == (warns ? 1 : 0));
        CHECK(log.count("at 6.00 s the newest frame is 200 ms old: forces fade") == (warns ? 1 : 0));
        CHECK(log.count("frames are fresh again") == (warns ? 2 : 0));
        CHECK(log.count("at 1.20 s frames are fresh again") == (warns ? 1 : 0));
        CHECK(log.count("at 9.00 s frames are fresh again") == (warns ? 1 : 0));
    }
}

TEST_CASE("Non-finite numbers that begin within the quiet time of the last warning are reported when that "
          "time is over, from the hand or elsewhere") {
    for (const bool fromHand : {true, false}) {
        CAPTURE(fromHand);
        const Listening log;
        NumberAlarm alarm;
        for (int tick = 0; tick < kTicks; ++tick) {
            TickRow row;
            row.record.t = 0.01 * tick;
            row.record.finite = !inSpell(tick);
            if (fromHand && inSpell(tick)) {
                row.hand.deviceThandle.position.x = std::numeric_limits<double>::quiet_NaN();
            }
            alarm.see(row);
        }
        const std::string cause = fromHand ? "the hand's sample is" : "a number of the tick is";
        CHECK(log.count("not finite") == 2);
        CHECK(log.count("at 1.00 s " + cause + " not finite: no force in such ticks") == 1);
        CHECK(log.count("at 6.00 s " + cause + " not finite: no force in such ticks") == 1);
    }
}
