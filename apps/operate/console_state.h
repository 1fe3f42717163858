// SPDX-License-Identifier: Apache-2.0
// The console's part of the state file.
#pragma once

#include "apps/operate/console.h"

#include <nlohmann/json.hpp>

namespace fathom::operate {

// Keys are only ever added. Window thread.
nlohmann::json stateOf(const Console& console);

} // namespace fathom::operate
