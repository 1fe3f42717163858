// SPDX-License-Identifier: Apache-2.0
// Group stiff: the closed loop of device, hand and fixtures.
#include "apps/stability/stiff_cases.h"

#include <iterator>

namespace fathom::stability {

std::vector<Case> stiffCases() {
    std::vector<Case> all;
    for (auto part : {boundaryCases, settlingCases, energyCases, pathCases, controllerCases}) {
        std::vector<Case> some = part();
        all.insert(all.end(), std::make_move_iterator(some.begin()), std::make_move_iterator(some.end()));
    }
    return all;
}

} // namespace fathom::stability
