// SPDX-License-Identifier: Apache-2.0
// Group feel, part four: cameras whose noise is far from what the program assumes.
#pragma once

#include "apps/stability/stability_case.h"

namespace fathom::stability {

void addFeelNoiseModel(std::vector<Case>& cases);

} // namespace fathom::stability
