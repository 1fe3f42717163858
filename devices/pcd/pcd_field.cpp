// SPDX-License-Identifier: Apache-2.0
#include "devices/pcd/pcd_field.h"

#include <algorithm>
#include <array>
#include <cstring>

namespace fathom {

namespace {

template <class T>
double valueAs(const uint8_t* from) {
    T value{};
    std::memcpy(&value, from, sizeof value);
    return static_cast<double>(value);
}

} // namespace

const PcdField* fieldNamed(std::span<const PcdField> fields, std::string_view name) {
    const auto found = std::ranges::find(fields, name, &PcdField::name);
    return found == fields.end() ? nullptr : &*found;
}

bool PcdField::isNumber() const {
    return type == 'F' ? size == 4 || size == 8 : size == 1 || size == 2 || size == 4;
}

double PcdField::at(const uint8_t* point, size_t value, bool bigEndian) const {
    const uint8_t* from = point + offset + value * size;
    std::array<uint8_t, 8> swapped;
    if (bigEndian) {
        std::reverse_copy(from, from + size, swapped.begin());
        from = swapped.data();
    }
    if (type == 'F') {
        return size == 8 ? valueAs<double>(from) : valueAs<float>(from);
    }
    const bool sign = type == 'I';
    switch (size) {
    case 1:
        return sign ? valueAs<int8_t>(from) : valueAs<uint8_t>(from);
    case 2:
        return sign ? valueAs<int16_t>(from) : valueAs<uint16_t>(from);
    default:
        return sign ? valueAs<int32_t>(from) : valueAs<uint32_t>(from);
    }
}

} // namespace fathom
