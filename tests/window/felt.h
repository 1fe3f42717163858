// SPDX-License-Identifier: Apache-2.0
// What a hand felt, as the CSV files of a recording and of a replay tell it.
#pragma once

#include <filesystem>
#include <vector>

namespace fathom::window {

struct Felt {
    double t = 0.0, force = 0.0; // [s], [N]
    bool contact = false;
};

// A CSV file's times, sizes of the force (its three components from column `force` on) and contacts.
std::vector<Felt> feltIn(const std::filesystem::path& file, size_t force, size_t contacts);

// One column of a CSV file, without its name.
std::vector<double> columnIn(const std::filesystem::path& file, size_t column);

// [s] of the first row above 1 N, of the first with a contact; -1 = none.
double firstRise(const std::vector<Felt>& rows);
double firstContact(const std::vector<Felt>& rows);

} // namespace fathom::window
