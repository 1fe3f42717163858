// SPDX-License-Identifier: Apache-2.0
// Reads the forces that a hand felt from the CSV files of a recording or replay.
#pragma once

#include <filesystem>
#include <vector>

namespace fathom::window {

// One row: the force on the hand at a time.
struct Felt {
    double t = 0.0, force = 0.0; // [s], [N]
    bool contact = false;
};

// Times, force magnitudes (three components from column `force` on) and contacts of a CSV file.
std::vector<Felt> feltIn(const std::filesystem::path& file, size_t force, size_t contacts);

// One column of a CSV file, without the header.
std::vector<double> columnIn(const std::filesystem::path& file, size_t column);

// [s] times of the first row above 1 N and of the first with a contact; -1 = none.
double firstRise(const std::vector<Felt>& rows);
double firstContact(const std::vector<Felt>& rows);

} // namespace fathom::window
