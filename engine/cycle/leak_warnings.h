// SPDX-License-Identifier: Apache-2.0
// Warns of classes whose region has gaps between its spheres.
#pragma once

#include "engine/cloud/collect.h"
#include "engine/scene/scene.h"

#include <vector>

namespace fathom {

// Once per class. One thread.
class LeakWarnings {
public:
    void check(const cloud::FrameCounts& counts, const Scene& scene);

private:
    std::vector<bool> warned_; // per point class
};

} // namespace fathom
