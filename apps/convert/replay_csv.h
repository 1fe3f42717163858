// SPDX-License-Identifier: Apache-2.0
// Columns of the CSV files of `replay --out`, read line by line.
#pragma once

#include "devices/recorded/text_file.h"

#include <optional>

namespace fathom {

// The numbers of chosen columns. One thread.
class ReplayCsv {
public:
    // columns: names that the first line must have. Throws BadInput.
    ReplayCsv(const std::filesystem::path& file, const std::vector<std::string>& columns);
    // In the order of `columns`; empty at the end. A line of another length or with a field that is no finite
    // number throws BadInput.
    std::optional<std::vector<double>> next();

private:
    [[noreturn]] void refuse(const TextLine& line, const std::string& field, const std::string& value) const;

    std::string name_;
    DataLines lines_;
    std::vector<std::string> columns_;
    std::vector<size_t> places_; // of the columns
    size_t fields_ = 0;          // of a line
};

} // namespace fathom
