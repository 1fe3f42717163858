// SPDX-License-Identifier: Apache-2.0
#include "tests/window/felt.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>
#include <string>

namespace fathom::window {

std::vector<Felt> feltIn(const std::filesystem::path& file, size_t force, size_t contacts) {
    std::ifstream in(file);
    std::vector<Felt> felt;
    std::string line;
    std::getline(in, line);
    while (std::getline(in, line)) {
        std::stringstream row(line);
        std::vector<double> cells;
        for (std::string cell; cells.size() <= contacts && std::getline(row, cell, ',');) {
            cells.push_back(std::stod(cell));
        }
        felt.push_back({cells.at(0), std::hypot(cells.at(force), cells.at(force + 1), cells.at(force + 2)),
                        cells.at(contacts) > 0.0});
    }
    return felt;
}

double firstRise(const std::vector<Felt>& rows) {
    const auto at = std::find_if(rows.begin(), rows.end(), [](const Felt& f) { return f.force > 1.0; });
    return at == rows.end() ? -1.0 : at->t;
}

double firstContact(const std::vector<Felt>& rows) {
    const auto at = std::find_if(rows.begin(), rows.end(), [](const Felt& f) { return f.contact; });
    return at == rows.end() ? -1.0 : at->t;
}

} // namespace fathom::window
