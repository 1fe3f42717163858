// SPDX-License-Identifier: Apache-2.0
#include "engine/cloud/fixture_set.h"

#include "engine/cloud/frame_params.h"

namespace fathom::cloud {

void FixtureSet::describeDevice(const Scene& scene, uint64_t frozenVersion, const gpu::Device::At& written) {
    rows.clear();
    for (const uint32_t row : classRows(scene)) {
        rows.push_back(scene.fixtures[row].frozen ? kStill : static_cast<int>(row));
    }
    stillVersion = frozenVersion;
    landed = written;
}

} // namespace fathom::cloud
