// SPDX-License-Identifier: Apache-2.0
// One row of a CSV file as text: commas without spaces, numbers with 17 significant digits, which restore a
// double exactly.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace fathom {

// Reuses its memory from row to row.
class CsvRow {
public:
    // Writes nan, inf or -inf (never -nan), which common readers accept.
    void add(double value);
    void add(int64_t value);
    void add(std::string_view word); // without comma, quote or line break
    // Ends the row. The view is valid until the next add(), which starts a new row.
    std::string_view end();

private:
    void separate();

    std::string text_;
    bool ended_ = false;
};

} // namespace fathom
