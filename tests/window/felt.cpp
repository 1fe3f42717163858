// SPDX-License-Identifier: Apache-2.0
#include "tests/window/felt.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>
#include <string>

namespace fathom::window {

std::vector<double> columnIn(const std::filesystem::path& file, size_t column) {
    std::ifstream in(file);
    std::vector<double> values;
    std::string line;
    std::getline(in, line);
    while (std::getline(in, line)) {
        std::stringstream row(line);
        std::string cell;
        for (size_t i = 0; i <= column; ++i) {
            std::getline(row, cell, ',');
        }
        values.push_back(std::stod(cell));
    }
    return values;
}

std::vector<Felt> feltIn(const std::filesystem::path& file, size_t force, size_t contacts) {
    const std::vector<double> t = columnIn(file, 0), x = columnIn(file, force), y = columnIn(file, force + 1),
                              z = columnIn(file, force + 2), touched = columnIn(file, contacts);
    std::vector<Felt> felt;
    for (size_t i = 0; i < t.size(); ++i) {
        felt.push_back({t[i], std::hypot(x[i], y[i], z[i]), touched[i] > 0.0});
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
