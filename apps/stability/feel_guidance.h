// SPDX-License-Identifier: Apache-2.0
// Group feel, part three: targets of guidance under a camera that sways, and the speed of its pull.
#pragma once

#include "apps/stability/stability_case.h"

namespace fathom::stability {

void addFeelGuidance(std::vector<Case>& cases);

} // namespace fathom::stability
