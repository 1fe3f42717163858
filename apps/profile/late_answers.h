// SPDX-License-Identifier: Apache-2.0
// Reach against stalls and lag when contact answers come late.
#pragma once

#include "apps/profile/study.h"

namespace fathom::profile {

// Appends to the query study: a row a reach and delay, with lag as error and the query's time, and the panel
// that shows them. Verifies that no leaf ever enters a sphere.
void addLateAnswers(const StudyContext& context, Study& study);

} // namespace fathom::profile
