// SPDX-License-Identifier: Apache-2.0
// Reach against stalls and lag with late contact answers.
#pragma once

#include "apps/profile/study.h"

#include <cstdint>
#include <vector>

namespace fathom::profile {

// Appends to the query study: one row per reach and delay, with lag as error and the query's time. Adds
// panels of lag against that time and of stalls against reach. Verifies that no leaf ever enters a sphere.
void addLateAnswers(const StudyContext& context, Study& study);

// Stalled ticks [% of `ticks`] over the reach [mm], one line per delay. Rows must be grouped by ascending
// delay. Lines overlap at 0 % and near 100 %, so shorter delays, which drop from 100 % at a smaller reach,
// are drawn on top.
PlotPanel stallPanel(const std::vector<StudyRow>& rows, uint32_t ticks);

} // namespace fathom::profile
