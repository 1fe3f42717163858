// SPDX-License-Identifier: Apache-2.0
// Converts a step record of the engine to a row of haptics.csv.
#pragma once

#include "apps/replay/tick_record.h"
#include "engine/cycle/step_record.h"

namespace fathom {

// stepMicros: compute time of the step [us]. late: it ended more than one period after its due start.
TickRecord tickOf(const StepRecord& tick, const ArmPosture& armStart, double stepMicros, bool late);

} // namespace fathom
