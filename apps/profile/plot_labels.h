// SPDX-License-Identifier: Apache-2.0
// Places a plot's labels: next to their points if there is room, otherwise farther away with a line to the
// point.
#pragma once

#include <cstddef>
#include <glm/vec2.hpp>
#include <string>
#include <vector>

namespace fathom::profile {

struct PlotBox { // [pixels] y downwards
    double x0, y0, x1, y1;
    bool meets(const PlotBox& o) const { return x0 < o.x1 && o.x0 < x1 && y0 < o.y1 && o.y0 < y1; }
};

struct LabelRequest {
    double x, y, width;    // [pixels] position of the point, width of the text
    std::string text = {}; // used to detect repeats
};

struct LabelPlace {
    double x, y;        // [pixels] left end of the text's baseline
    bool beside = true; // false: a line leads to the point
    PlotBox box;        // bounds of the text
};

// Ascending indices of the requests to draw. Skips a request whose text repeats an earlier one at a touching
// dot, so that equal settings with equal results are labelled once.
std::vector<size_t> distinctLabels(const std::vector<LabelRequest>& requests);

// Adds boxes that cover the line from a to b, for `taken` below. [pixels]
void addLine(glm::dvec2 a, glm::dvec2 b, std::vector<PlotBox>& taken);

// One place per request, in order; earlier requests get better places. `taken`: boxes that no label may
// overlap, including those of points and lines. Labels do not overlap while `room` has a free place. After
// that, a label goes next to its point anyway, because none is dropped.
std::vector<LabelPlace> placeLabels(const std::vector<LabelRequest>& requests, const PlotBox& room,
                                    std::vector<PlotBox> taken);

} // namespace fathom::profile
