// SPDX-License-Identifier: Apache-2.0
#include "apps/register/point_pairs.h"

#include "engine/types/error.h"

#include <fstream>
#include <sstream>

namespace fathom {

std::vector<PointPair> readPointPairs(const std::filesystem::path& file) {
    std::ifstream in(file);
    if (!in) {
        throw BadInput(file.string(), "file", "cannot be read",
                       "CSV rows camera_x,camera_y,camera_z,base_x,base_y,base_z [m]");
    }
    std::vector<PointPair> pairs;
    int number = 0;
    for (std::string line; std::getline(in, line);) {
        ++number;
        if (line.empty() || line[0] == '#' || line[0] == 'c') { // a comment, or the header
            continue;
        }
        std::string spaced = line;
        for (char& c : spaced) {
            c = c == ',' ? ' ' : c;
        }
        std::istringstream words(spaced);
        PointPair pair;
        std::string more;
        dvec3 &c = pair.camera, &b = pair.base;
        if (!(words >> c.x >> c.y >> c.z >> b.x >> b.y >> b.z) || words >> more) {
            throw BadInput(file.string(), "line " + std::to_string(number), line, "six numbers [m]");
        }
        pair.name = "line " + std::to_string(number);
        pairs.push_back(pair);
    }
    return pairs;
}

} // namespace fathom
