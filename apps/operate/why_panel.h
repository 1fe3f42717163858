// SPDX-License-Identifier: Apache-2.0
// Explains each block: class, region sphere, depth, and since which frame.
#pragma once

#include "apps/operate/console.h"
#include "apps/operate/run_view.h"

#include <string>

namespace fathom::operate {

// One block in one sentence.
std::string whyBlocked(const Block& block, const Scene& scene, const HostFixtures& set);
// armHolds: measured_arm.h.
void drawWhy(const RunView& run, const Scene& scene, const std::vector<std::string>& armHolds);

} // namespace fathom::operate
