// SPDX-License-Identifier: Apache-2.0
// Draws one item into a part of an image.
#pragma once

#include "apps/operate/panel_raster.h"

namespace fathom::operate {

// The image, 0xAARRGGBB.
struct RasterImage {
    uint32_t* pixels = nullptr;
    int width = 0;
    uint32_t* row(int y) const { return pixels + static_cast<size_t>(y) * static_cast<size_t>(width); }
};

// Pixels whose centre is inside the item and `within`, which is inside the image. Two triangles with a common
// edge cover no pixel twice and leave none out.
void fillItem(const RasterImage& image, const PanelItem& item, const PixelBox& within, const Coverage& fonts);

// Whether the item hides everything below it in the box.
bool hides(const PanelItem& item, const PixelBox& box, const Coverage& fonts);

} // namespace fathom::operate
