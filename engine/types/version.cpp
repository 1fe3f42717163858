// SPDX-License-Identifier: Apache-2.0
#include "engine/types/version.h"

namespace fathom {

const char* version() noexcept {
    return FATHOM_VERSION;
}

} // namespace fathom
