// SPDX-License-Identifier: Apache-2.0
// Whether the Vulkan layers watch what the tests run.
#pragma once

#include "tests/support/sanitized.h"

#include <cstdlib>
#include <string>

namespace fathom::test {

// FATHOM_TEST_VALIDATION: 0 leaves the layers out, as sanitized trees do; gpu: their checks inside of
// shaders, too.
inline std::string validationSetting() {
    const char* set = std::getenv("FATHOM_TEST_VALIDATION");
    return set != nullptr ? set : kSanitized ? "0" : "1";
}
inline bool validationWanted() {
    return validationSetting() != "0";
}

} // namespace fathom::test
