// SPDX-License-Identifier: Apache-2.0
// `fathom plan SCENE`: which passes, buffers and threads a scene gets on a device, which are skipped, and
// why.
#pragma once

#include "apps/global_options.h"
#include "engine/scene/plan.h"

#include <ostream>

namespace CLI {
class App;
}

namespace fathom {

void addPlanCommand(CLI::App& app, const GlobalOptions& global);

// One line per item: kind, name, in or out, bytes, reason.
void printPlan(std::ostream& out, const Plan& plan);

} // namespace fathom
