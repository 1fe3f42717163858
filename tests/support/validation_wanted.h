// SPDX-License-Identifier: Apache-2.0
// Whether the tests run with the Vulkan validation layers.
#pragma once

#include "tests/support/sanitized.h"

#include <cstdlib>
#include <string>

namespace fathom::testing {

// FATHOM_TEST_VALIDATION: 0 = without layers, as in sanitized builds; gpu = also GPU-assisted checks in
// shaders.
inline std::string validationSetting() {
    const char* set = std::getenv("FATHOM_TEST_VALIDATION");
    return set != nullptr ? set : kSanitized ? "0" : "1";
}
inline bool validationWanted() {
    return validationSetting() != "0";
}

} // namespace fathom::testing
