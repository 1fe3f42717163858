// SPDX-License-Identifier: Apache-2.0
// One field of the points of a PCD file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace fathom {

// As FIELDS, SIZE, TYPE and COUNT state it.
struct PcdField {
    std::string name;
    size_t size = 4, count = 1, offset = 0; // [bytes], values, [bytes] in a point
    char type = 'F';                        // F real, I signed, U unsigned

    // Whether at() can read it: F of 4 or 8 bytes, others of 1, 2 or 4.
    bool isNumber() const;
    // One of its `count` values. point: the first byte of a point that has the whole field.
    double at(const uint8_t* point, size_t value = 0, bool bigEndian = false) const;
};

// The first one of that name, or null.
const PcdField* fieldNamed(std::span<const PcdField> fields, std::string_view name);

} // namespace fathom
