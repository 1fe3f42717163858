// SPDX-License-Identifier: Apache-2.0
// What `fathom plan` says: each pass, buffer and thread that a plan includes or skips, with the reason.
#pragma once

#include "engine/scene/plan.h"

namespace fathom {

// Appends the items of a plan that is decided.
void explainPlan(Plan& plan, const Scene& scene, const CameraInfo& camera);

// Why depths cannot be averaged over frames; null when they can.
const char* whyNoEstimates(const Scene& scene, const CameraInfo& camera);

} // namespace fathom
