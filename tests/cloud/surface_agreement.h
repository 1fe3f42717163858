// SPDX-License-Identifier: Apache-2.0
// Compares the points of surface.comp with the twin's.
#pragma once

#include "engine/reference/surface.h"
#include "tests/support/cloud_rig.h"

#include <algorithm>
#include <cmath>

namespace fathom::testing {

struct SurfaceAgreement {
    uint32_t points = 0, rejected = 0, unsure = 0,
             wrong = 0; // wrong: kept by one and rejected by the other, away from thresholds
    double worst = 0.0; // [m] distance to the twin's point; beyond 1 m, divided by the range
};

inline SurfaceAgreement comparePoints(const CloudRig& rig) {
    const std::vector<uint32_t> masks = rig.masks();
    const reference::SurfaceImage twin = reference::surface(rig.view(), masks);
    const reference::PointImage points = rig.points();
    SurfaceAgreement a;
    for (size_t i = 0; i < masks.size(); ++i) {
        const bool here = points.z[i] != 0.0, there = twin.points.z[i] != 0.0;
        a.points += here, a.rejected += masks[i] != 0 && !here;
        a.unsure += twin.unsure[i];
        a.wrong += here != there && twin.unsure[i] == 0;
        if (here && there) {
            const double scale = std::max(1.0, twin.points.z[i]);
            a.worst = std::max(a.worst, glm::distance(points.at[i], twin.points.at[i]) / scale);
            a.worst = std::max(a.worst, std::abs(points.z[i] - twin.points.z[i]) / scale);
        }
    }
    return a;
}

inline Scene edgeScene(double edge) {
    Scene scene = plainScene();
    scene.filter.edge = edge;
    return scene;
}

// Blocks are for CPU devices; a GPU's compiler may reorder or fuse their sums.
inline bool onCpu() {
    return vulkan().device.facts().kind == DeviceKind::Cpu;
}

} // namespace fathom::testing
