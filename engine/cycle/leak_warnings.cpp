// SPDX-License-Identifier: Apache-2.0
#include "engine/cycle/leak_warnings.h"

#include "engine/cloud/frame_params.h"
#include "engine/types/log.h"

namespace fathom {

void LeakWarnings::check(const cloud::FrameCounts& counts, const Scene& scene) {
    warned_.resize(counts.leakSpacing.size());
    for (size_t c = 0; c < counts.leakSpacing.size(); ++c) {
        if (counts.leakSpacing[c] > 0.0f && !warned_[c]) {
            warned_[c] = true;
            const FixtureClass& f = scene.fixtures[cloud::classFixtures(scene)[c]];
            log::warn("fixture '{}' leaks: at {:.2f} m its points are {:.1f} mm apart and its spheres "
                      "have a radius of {:.1f} mm",
                      f.name, counts.leakRange[c], counts.leakSpacing[c] * 1e3, f.radius * 1e3);
        }
    }
}

} // namespace fathom
