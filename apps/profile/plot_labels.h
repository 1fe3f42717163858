// SPDX-License-Identifier: Apache-2.0
// Where the labels of a plot stand: each beside its point where there is room, else farther off with a line
// to it.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace fathom::profile {

struct PlotBox { // [pixels] y downwards
    double x0, y0, x1, y1;
    bool meets(const PlotBox& o) const { return x0 < o.x1 && o.x0 < x1 && y0 < o.y1 && o.y0 < y1; }
};

struct LabelRequest {
    double x, y, width;    // [pixels] of the point, of the text
    std::string text = {}; // by which repeats are known
};

struct LabelPlace {
    double x, y;        // [pixels] left end of the text's baseline
    bool beside = true; // else a line leads to the point
    PlotBox box;        // that the text fills
};

// Indices, ascending, of the wishes but those that say of a point what one before them says of another that
// its dot touches: settings that come out alike are named once.
std::vector<size_t> distinctLabels(const std::vector<LabelRequest>& requests);

// One place a wish, in their order: the first have the better ones. `taken` are boxes that no label may meet,
// the points among them. No two labels meet while the room has a free spot; after that one stands beside its
// point all the same, for none is left out.
std::vector<LabelPlace> placeLabels(const std::vector<LabelRequest>& requests, const PlotBox& room,
                                    std::vector<PlotBox> taken);

} // namespace fathom::profile
