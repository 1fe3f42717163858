// SPDX-License-Identifier: Apache-2.0
#include "apps/register/point_pairs.h"

#include "engine/types/error.h"
#include "engine/types/split_words.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <glm/geometric.hpp>
#include <sstream>

namespace fathom {

bool isNear(const dvec3& p) {
    return isFinite(p) && std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) <= 1e6; // [m]
}

bool isNear(const Pose& target, double size) {
    return isNear(target.position) && glm::length(target.rotation) > 1e-6 &&
           glm::length(target.rotation) < 1e6 && size >= 1e-3 && size <= 10.0; // [m]
}

std::vector<TextLine> readRows(const std::filesystem::path& file, const std::string& header) {
    std::vector<TextLine> rows = readDataLines(file);
    if (rows.empty() || std::isalpha(static_cast<unsigned char>(rows[0].text[0])) == 0) {
        return rows;
    }
    const auto spaced = [](std::string line) {
        std::replace(line.begin(), line.end(), ',', ' ');
        return line;
    };
    const std::string first = spaced(rows[0].text), wanted = spaced(header);
    if (splitWords(first) != splitWords(wanted)) {
        throw BadInput(file.string(), "line " + std::to_string(rows[0].number), rows[0].text.substr(0, 160),
                       "header " + header);
    }
    rows.erase(rows.begin());
    return rows;
}

namespace {

// Throws BadInput where points lie behind the camera: rows are those of the pairs.
void refuseBehind(const std::filesystem::path& file, const std::vector<TextLine>& rows,
                  const std::vector<PointPair>& pairs) {
    constexpr const char* kAllowed =
        "camera_z above 0: x right, y down, z forward; of axes with y up negate y and z";
    const auto behind = [](const PointPair& pair) { return !(pair.camera.z > 0.0); };
    if (pairs.size() > 1 && std::all_of(pairs.begin(), pairs.end(), behind)) {
        throw BadInput(file.string(), "camera_z",
                       "all " + std::to_string(pairs.size()) + " points are behind the camera", kAllowed);
    }
    const auto first = std::find_if(pairs.begin(), pairs.end(), behind);
    if (first != pairs.end()) {
        const TextLine& line = rows[static_cast<size_t>(first - pairs.begin())];
        throw BadInput(file.string(), "line " + std::to_string(line.number),
                       line.text.substr(0, 160) + ", which is behind the camera", kAllowed);
    }
}

} // namespace

std::vector<PointPair> readPointPairs(const std::filesystem::path& file) {
    const std::vector<TextLine> rows = readRows(file, "camera_x,camera_y,camera_z,base_x,base_y,base_z");
    std::vector<PointPair> pairs;
    for (const TextLine& line : rows) {
        std::string spaced = line.text;
        std::replace(spaced.begin(), spaced.end(), ',', ' ');
        std::istringstream words(spaced);
        PointPair pair;
        std::string more;
        dvec3 &c = pair.camera, &b = pair.base;
        if (!(words >> c.x >> c.y >> c.z >> b.x >> b.y >> b.z) || words >> more || !isNear(c) || !isNear(b)) {
            throw BadInput(
                file.string(), "line " + std::to_string(line.number), line.text.substr(0, 160),
                "six numbers camera_x,camera_y,camera_z,base_x,base_y,base_z, up to 1e6 m, separated "
                "by commas or spaces");
        }
        pair.name = "line " + std::to_string(line.number);
        pairs.push_back(pair);
    }
    refuseBehind(file, rows, pairs);
    return pairs;
}

} // namespace fathom
