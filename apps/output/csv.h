// SPDX-License-Identifier: Apache-2.0
// Formats one row of a CSV file: commas without spaces, numbers with 17 significant digits, which restore
// every double exactly.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace fathom {

// Reuses its memory for every row.
class CsvRow {
public:
    // Writes nan, inf or -inf (never -nan), which common readers accept.
    void add(double value);
    void add(int64_t value);
    void add(std::string_view word); // must not contain a comma, quote or line break
    // Ends the row. The view is valid until the next add(), which starts a new row.
    std::string_view end();

private:
    void separate();

    std::string text_;
    bool ended_ = false;
};

} // namespace fathom
