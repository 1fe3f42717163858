// SPDX-License-Identifier: Apache-2.0
#include "apps/profile/plot_labels.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <optional>

namespace fathom::profile {

namespace {

constexpr double kAscent = 11.0, kDescent = 3.0, kGap = 11.0; // [pixels]
constexpr double kTouching = 10.0;                            // [pixels] centre distance of two touching dots
// [pixels] between labels of one row, and around one that a line leads to
constexpr double kApart = 6.0;
constexpr double kLevel = 4.0; // [pixels] of a line's end above the text's baseline
constexpr int kDirections = 24;

LabelPlace placeAt(const LabelRequest& request, double x, double y, bool beside) {
    return {x, y, beside, {x, y - kAscent, x + request.width, y + kDescent}};
}

bool isFree(const PlotBox& box, const PlotBox& room, const std::vector<PlotBox>& taken) {
    return box.x0 > room.x0 && box.x1 < room.x1 && box.y0 > room.y0 && box.y1 < room.y1 &&
           std::none_of(taken.begin(), taken.end(), [&](const PlotBox& b) { return b.meets(box); });
}

// Tries right and left of the point, each above, level and below.
std::optional<LabelPlace> placeBeside(const LabelRequest& request, const PlotBox& room,
                                      const std::vector<PlotBox>& taken) {
    for (const double dx : {kGap, -kGap - request.width}) {
        for (const double dy : {-7.0, 4.0, 18.0}) {
            const LabelPlace place = placeAt(request, request.x + dx, request.y + dy, true);
            if (isFree(place.box, room, taken)) {
                return place;
            }
        }
    }
    return {};
}

// Tries rings around the point, nearest first.
std::optional<LabelPlace> placeOff(const LabelRequest& request, const PlotBox& room,
                                   const std::vector<PlotBox>& taken) {
    const double farthest = std::hypot(room.x1 - room.x0, room.y1 - room.y0);
    for (double ring = 24.0; ring < farthest; ring += 8.0) {
        for (int k = 0; k < kDirections; ++k) {
            const double angle = 2.0 * M_PI * k / kDirections, x = request.x + ring * std::cos(angle),
                         y = request.y + ring * std::sin(angle);
            const LabelPlace place =
                placeAt(request, std::cos(angle) < 0.0 ? x - request.width : x, y, false);
            const auto& [x0, y0, x1, y1] = place.box;
            if (isFree({x0 - kApart, y0 - kApart, x1 + kApart, y1 + kApart}, room, taken)) {
                return place;
            }
        }
    }
    return {};
}

} // namespace

std::vector<size_t> distinctLabels(const std::vector<LabelRequest>& requests) {
    std::vector<size_t> kept;
    for (size_t i = 0; i < requests.size(); ++i) {
        const LabelRequest& request = requests[i];
        const bool repeats = std::any_of(kept.begin(), kept.end(), [&](size_t k) {
            return requests[k].text == request.text &&
                   std::hypot(requests[k].x - request.x, requests[k].y - request.y) < kTouching;
        });
        if (!repeats) {
            kept.push_back(i);
        }
    }
    return kept;
}

void addLine(glm::dvec2 a, glm::dvec2 b, std::vector<PlotBox>& taken) {
    constexpr double kPart = 8.0, kHalf = 3.0;      // [pixels] length of a part, half the width of the line
    const bool straight = a.x == b.x || a.y == b.y; // one box is enough
    const int parts = straight ? 1 : static_cast<int>(std::ceil(glm::distance(a, b) / kPart));
    for (int i = 0; i < parts; ++i) {
        const glm::dvec2 from = glm::mix(a, b, static_cast<double>(i) / parts),
                         to = glm::mix(a, b, static_cast<double>(i + 1) / parts);
        taken.push_back({std::min(from.x, to.x) - kHalf, std::min(from.y, to.y) - kHalf,
                         std::max(from.x, to.x) + kHalf, std::max(from.y, to.y) + kHalf});
    }
}

std::vector<LabelPlace> placeLabels(const std::vector<LabelRequest>& requests, const PlotBox& room,
                                    std::vector<PlotBox> taken) {
    std::vector<LabelPlace> places;
    for (const LabelRequest& request : requests) {
        std::optional<LabelPlace> place = placeBeside(request, room, taken);
        place = place ? place : placeOff(request, room, taken);
        places.push_back(place ? *place : placeAt(request, request.x + kGap, request.y - 7.0, true));
        const auto& [x0, y0, x1, y1] = places.back().box;
        taken.push_back({x0 - kApart, y0, x1 + kApart, y1});
        if (!places.back().beside) {
            const double end = x0 >= request.x ? x0 : x1;
            addLine({request.x, request.y}, {end, places.back().y - kLevel}, taken);
        }
    }
    return places;
}

} // namespace fathom::profile
