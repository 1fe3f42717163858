// SPDX-License-Identifier: Apache-2.0
// Descriptors of the passes that make the region spheres.
#pragma once

#include "engine/cloud/pass.h"

namespace fathom::cloud {

// One pass on GPUs; on CPU devices a second one for patches that hold points, when the scene holds.
std::vector<PassInfo> spherePasses(const CloudContext& context);

} // namespace fathom::cloud
