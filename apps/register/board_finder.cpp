// SPDX-License-Identifier: Apache-2.0
#include "apps/register/board_finder.h"

#include "apps/register/board_corners.h"
#include "apps/register/point_pairs.h"
#include "apps/register/seen_plane.h"
#include "engine/types/error.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <sstream>

namespace fathom {

BoardPlace readBoardPlace(const std::filesystem::path& file) {
    constexpr const char* kAllowed =
        "one row columns,rows,square_m,x,y,z,qx,qy,qz,qw: 3 to 40 inner corners "
        "per side, odd sum, squares of 0.001 to 10 m, position within 1e6 m, valid quaternion";
    BoardPlace place;
    for (const TextLine& line : readRows(file, "columns,rows,square_m,x,y,z,qx,qy,qz,qw")) {
        std::string spaced = line.text;
        std::replace(spaced.begin(), spaced.end(), ',', ' ');
        std::istringstream words(spaced);
        int columns = 0, rows = 0;
        dvec3& t = place.baseTboard.position;
        dquat& q = place.baseTboard.rotation;
        std::string more;
        const bool again = place.columns != 0;
        const bool read = static_cast<bool>(words >> columns >> rows >> place.square >> t.x >> t.y >> t.z >>
                                            q.x >> q.y >> q.z >> q.w);
        const bool sized = std::min(columns, rows) >= 3 && std::max(columns, rows) <= 40;
        if (!read || words >> more || again || !sized || (columns + rows) % 2 == 0 ||
            !isNear(place.baseTboard, place.square)) {
            throw BadInput(file.string(), "line " + std::to_string(line.number), line.text.substr(0, 160),
                           kAllowed);
        }
        q = glm::normalize(q);
        place.columns = static_cast<uint32_t>(columns);
        place.rows = static_cast<uint32_t>(rows);
    }
    if (place.columns == 0) {
        throw BadInput(file.string(), "rows", "none", kAllowed);
    }
    return place;
}

std::vector<PointPair> BoardFinder::find(const Frame& frame) {
    greyOf(frame, grey_);
    const uint32_t columns = place_.columns, rows = place_.rows;
    const auto corners = boardCorners(grey_, camera_.colour.width, camera_.colour.height, columns, rows);
    if (corners.empty()) {
        return {};
    }
    const auto plane = SeenPlane::inside(
        frame, camera_,
        {corners.front(), corners[columns - 1], corners.back(), corners[corners.size() - columns]});
    std::vector<PointPair> pairs;
    for (size_t i = 0; plane && i < corners.size(); ++i) {
        const size_t row = i / columns;
        const dvec3 own(place_.square * static_cast<double>(i % columns),
                        place_.square * static_cast<double>(row), 0.0);
        pairs.push_back({plane->at(corners[i]), place_.baseTboard.apply(own), "corner " + std::to_string(i)});
    }
    return pairs;
}

} // namespace fathom
