// SPDX-License-Identifier: Apache-2.0
// Reach against stalls and lag when contact answers come late.
#pragma once

#include "apps/profile/study.h"

#include <cstdint>
#include <vector>

namespace fathom::profile {

// Appends to the query study: a row a reach and delay, with lag as error and the query's time, and the panels
// of lag against that time and of stalls against the reach. Verifies that no leaf ever enters a sphere.
void addLateAnswers(const StudyContext& context, Study& study);

// Stalled turns of such rows [% of the drag's `ticks`] over the reach [mm], a line a delay. Rows of one delay
// stand together, delays ascend. Most lines lie on 0 % or near 100 %: those of a shorter delay, which leave
// the top earlier, are drawn over those of a longer one, so that each is seen as far as it stalls.
PlotPanel stallPanel(const std::vector<StudyRow>& rows, uint32_t ticks);

} // namespace fathom::profile
