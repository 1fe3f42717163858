// SPDX-License-Identifier: Apache-2.0
// The camera image of the window: regions tinted and hatched; unobserved areas (no depth) use a second hatch.
#pragma once

#include "apps/operate/snapshots.h"
#include "apps/output/image_view.h"
#include "apps/output/silhouette.h"

#include <vector>

namespace fathom::operate {

// Which depth pixels a preview selects; empty = no preview.
using Selection = std::vector<uint8_t>;

// Composed per frame. Colours have the meaning they have in overlay.png.
class CameraViewImage {
public:
    // Regions with half of the resolution, which takes a third of the time.
    void setCoarse(bool coarse) { coarse_ = coarse; }
    // selection: size of the depth image, or empty; drawn in cyan.
    void compose(const SceneSnapshot& scene, const Selection& selection);

    const std::vector<uint32_t>& pixels() const { return pixels_; } // 0xAABBGGRR, view().width() x height()
    const ImageView& view() const { return view_; }
    const std::vector<OutlineLine>& seenOutline() const { return seen_; }
    const std::vector<OutlineLine>& heldOutline() const { return held_; }
    double unknownShare() const { return unknown_; } // share of the image without depth, 0..1

private:
    void paintImage(const SceneSnapshot& scene, const Selection& selection);
    void paintRegions(const HostFixtures& set);

    ImageView view_;
    std::vector<uint32_t> pixels_;
    std::vector<OutlineLine> seen_, held_;
    double unknown_ = 0.0;
    bool coarse_ = false;
};

} // namespace fathom::operate
