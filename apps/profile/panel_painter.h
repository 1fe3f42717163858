// SPDX-License-Identifier: Apache-2.0
// Paints one panel of a plot.
#pragma once

#include "apps/profile/panel_colours.h"

namespace fathom::profile {

// Draws the panel. left, top: of its rectangle in the image [pixels].
void paintPanel(const Image& image, const PlotPanel& panel, const ColourTable& colours, double left,
                double top);

} // namespace fathom::profile
