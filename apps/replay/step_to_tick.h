// SPDX-License-Identifier: Apache-2.0
// A turn of the engine as a row of haptics.csv.
#pragma once

#include "apps/replay/tick_record.h"
#include "engine/cycle/step_record.h"

namespace fathom {

// stepMicros: compute time of the tick [us]; late: it ended more than one period after its start was due.
TickRecord tickOf(const StepRecord& tick, const ArmPosture& armStart, double stepMicros, bool late);

} // namespace fathom
