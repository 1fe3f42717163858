// SPDX-License-Identifier: Apache-2.0
#include "apps/profile/plot_labels.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace fathom::profile {

namespace {

constexpr double kAscent = 11.0, kDescent = 3.0, kGap = 11.0; // [pixels]
constexpr double kTouching = 10.0;                            // [pixels] centre distance of two touching dots
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
            if (isFree(place.box, room, taken)) {
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

std::vector<LabelPlace> placeLabels(const std::vector<LabelRequest>& requests, const PlotBox& room,
                                    std::vector<PlotBox> taken) {
    std::vector<LabelPlace> places;
    for (const LabelRequest& request : requests) {
        std::optional<LabelPlace> place = placeBeside(request, room, taken);
        place = place ? place : placeOff(request, room, taken);
        places.push_back(place ? *place : placeAt(request, request.x + kGap, request.y - 7.0, true));
        taken.push_back(places.back().box);
    }
    return places;
}

} // namespace fathom::profile
