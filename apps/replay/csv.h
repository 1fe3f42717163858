// SPDX-License-Identifier: Apache-2.0
// One row of a CSV file as text: commas without spaces, numbers with 17 significant digits (a double
// survives).
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace fathom {

// The text keeps its memory between rows.
class CsvRow {
public:
    // Not finite is written nan, inf or -inf (never -nan), which the usual readers take as numbers.
    void add(double value);
    void add(int64_t value);
    void add(std::string_view word); // must hold no comma, quote or line break
    // Ends the row; the next add() starts a new one. The view lives until then.
    std::string_view end();

private:
    void separate();

    std::string text_;
    bool ended_ = false;
};

} // namespace fathom
