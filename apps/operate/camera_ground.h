// SPDX-License-Identifier: Apache-2.0
// The camera's picture as the pilot sees it: regions tinted and hatched, and hatched in another way where the
// camera has not seen how far things are.
#pragma once

#include "apps/operate/snapshots.h"
#include "apps/replay/image_view.h"
#include "apps/replay/silhouette.h"

#include <vector>

namespace fathom::operate {

// Which pixels of the colour picture a preview selects; empty = no preview.
using Selection = std::vector<uint8_t>;

// Made anew for each picture. Colours and meaning are those of overlay.png.
class CameraGround {
public:
    // selection: of the depth picture's size or empty; marked cyan.
    void compose(const SceneSnapshot& scene, const Selection& selection);

    const std::vector<uint32_t>& pixels() const { return pixels_; } // 0xAABBGGRR, view().width() x height()
    const ImageView& view() const { return view_; }
    const std::vector<OutlineLine>& seenOutline() const { return seen_; }
    const std::vector<OutlineLine>& heldOutline() const { return held_; }
    double unknownShare() const { return unknown_; } // of the picture without depth, 0..1

private:
    void paintImage(const SceneSnapshot& scene, const Selection& selection);
    void paintRegions(const Fixtures& set);

    ImageView view_;
    std::vector<uint32_t> pixels_;
    std::vector<OutlineLine> seen_, held_;
    double unknown_ = 0.0;
};

} // namespace fathom::operate
