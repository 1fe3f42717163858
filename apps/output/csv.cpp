// SPDX-License-Identifier: Apache-2.0
#include "apps/output/csv.h"

#include <charconv>
#include <cmath>

namespace fathom {

void CsvRow::add(double value) {
    separate();
    if (std::isnan(value)) {
        text_ += "nan";
        return;
    }
    char digits[40];
    const auto result = std::to_chars(digits, digits + sizeof digits, value, std::chars_format::general, 17);
    text_.append(digits, result.ptr);
}

void CsvRow::add(int64_t value) {
    separate();
    char digits[24];
    const auto result = std::to_chars(digits, digits + sizeof digits, value);
    text_.append(digits, result.ptr);
}

void CsvRow::add(std::string_view word) {
    separate();
    text_ += word;
}

std::string_view CsvRow::end() {
    text_ += '\n';
    ended_ = true;
    return text_;
}

void CsvRow::separate() {
    if (ended_) {
        text_.clear();
        ended_ = false;
    }
    if (!text_.empty()) {
        text_ += ',';
    }
}

} // namespace fathom
