// SPDX-License-Identifier: Apache-2.0
#include "engine/reference/occlusion.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fathom::reference {

namespace {

// Lowers every cell that the image position (u, v) +- slack may belong to. Returns their number.
int lowerCells(CellImage& cells, const Intrinsics& lens, double u, double v, double slack, double z) {
    int touched = 0;
    int last[4][2] = {};
    for (const double du : {-slack, slack}) {
        for (const double dv : {-slack, slack}) {
            const long pu = std::lround(u + du), pv = std::lround(v + dv);
            if (pu < 0 || pv < 0 || pu >= static_cast<long>(lens.width) ||
                pv >= static_cast<long>(lens.height)) {
                continue;
            }
            const int cu = static_cast<int>(pu / cells.edge), cv = static_cast<int>(pv / cells.edge);
            const auto same = [&](const int(&l)[2]) { return l[0] == cu && l[1] == cv; };
            if (std::any_of(last, last + touched, same)) {
                continue;
            }
            last[touched][0] = cu, last[touched][1] = cv;
            ++touched;
            double& nearest = cells.nearest[static_cast<size_t>(cv) * cells.across + static_cast<size_t>(cu)];
            nearest = std::min(nearest, z);
        }
    }
    return touched;
}

bool insideBy(const Intrinsics& lens, double u, double v, double slack) {
    return u > -0.5 + slack && v > -0.5 + slack && u < lens.width - 0.5 - slack &&
           v < lens.height - 0.5 - slack;
}

} // namespace

CellImage emptyCells(const CameraInfo& camera) {
    CellImage cells;
    const double ratio = std::max(camera.colour.fx / camera.depth.fx, camera.colour.fy / camera.depth.fy);
    cells.edge = static_cast<uint32_t>(std::max(1.0, std::ceil(1.5 * ratio)));
    cells.across = (camera.colour.width + cells.edge - 1) / cells.edge;
    cells.down = (camera.colour.height + cells.edge - 1) / cells.edge;
    cells.nearest.assign(static_cast<size_t>(cells.across) * cells.down,
                         std::numeric_limits<double>::infinity());
    return cells;
}

CellBounds occlusion(const FrameView& view, double slack) {
    CellBounds bounds{emptyCells(view.camera()), emptyCells(view.camera())};
    for (int v = 0; v < view.height(); ++v) {
        for (int u = 0; u < view.width(); ++u) {
            const double z = view.z(u, v);
            if (z == 0.0) {
                continue;
            }
            const dvec3 q = view.camera().colourTdepth.apply(view.point(u, v, z));
            if (q.z <= 0.0) {
                continue;
            }
            const Intrinsics& lens = view.camera().colour;
            const glm::dvec2 at = lens.project(q);
            const int cells = lowerCells(bounds.possible, lens, at.x, at.y, slack, q.z);
            if (cells == 1 && insideBy(lens, at.x, at.y, slack)) {
                lowerCells(bounds.sure, lens, at.x, at.y, 0.0, q.z);
            }
        }
    }
    return bounds;
}

} // namespace fathom::reference
