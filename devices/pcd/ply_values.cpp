// SPDX-License-Identifier: Apache-2.0
#include "devices/pcd/ply_values.h"

#include "engine/types/error.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstring>

namespace fathom {

namespace {

template <class T>
double plyNumber(const uint8_t* bytes) {
    T value;
    std::memcpy(&value, bytes, sizeof value);
    return static_cast<double>(value);
}

} // namespace

double PlyValues::property(const PlyProperty& property, const std::string& element, uint64_t index) {
    if (!property.list) {
        return next(property.type, element, index);
    }
    const double count = next(property.countType, element, index);
    if (!(count >= 0.0 && count == std::floor(count) && count <= static_cast<double>(text_.size()))) {
        refuse("element " + element, "a list with " + std::to_string(count) + " values",
               "a number that fits the file");
    }
    double first = NAN;
    for (uint64_t i = 0; i < static_cast<uint64_t>(count); ++i) {
        const double value = next(property.type, element, index);
        first = i == 0 ? value : first;
    }
    return first;
}

void PlyValues::refuse(const std::string& field, const std::string& value, const std::string& allowed) const {
    throw BadInput(file_, field, value, allowed);
}

void PlyValues::cutOff(const std::string& element, uint64_t index) const {
    refuse("element " + element, "ends at " + std::to_string(index), "as many as the header states");
}

double PlyValues::next(PlyType type, const std::string& element, uint64_t index) {
    return format_ == PlyFormat::Ascii ? word(element, index) : binary(type, element, index);
}

double PlyValues::word(const std::string& element, uint64_t index) {
    const size_t begin = text_.find_first_not_of(" \t\r\n", at_);
    if (begin == std::string_view::npos) {
        cutOff(element, index);
    }
    const size_t end = std::min(text_.find_first_of(" \t\r\n", begin), text_.size());
    const std::string_view word = text_.substr(begin, end - begin);
    at_ = end;
    double value = 0.0;
    const auto [last, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error == std::errc::invalid_argument || last != word.data() + word.size()) {
        refuse("element " + element + " " + std::to_string(index), std::string(word.substr(0, 40)),
               "numbers");
    }
    return value;
}

double PlyValues::binary(PlyType type, const std::string& element, uint64_t index) {
    std::array<uint8_t, 8> bytes{};
    const size_t size = plyBytes(type);
    if (text_.size() - at_ < size) {
        cutOff(element, index);
    }
    for (size_t i = 0; i < size; ++i) {
        const size_t to = format_ == PlyFormat::BigEndian ? size - 1 - i : i;
        bytes[to] = static_cast<uint8_t>(text_[at_ + i]);
    }
    at_ += size;
    switch (type) {
    case PlyType::Int8:
        return plyNumber<int8_t>(bytes.data());
    case PlyType::Uint8:
        return plyNumber<uint8_t>(bytes.data());
    case PlyType::Int16:
        return plyNumber<int16_t>(bytes.data());
    case PlyType::Uint16:
        return plyNumber<uint16_t>(bytes.data());
    case PlyType::Int32:
        return plyNumber<int32_t>(bytes.data());
    case PlyType::Uint32:
        return plyNumber<uint32_t>(bytes.data());
    case PlyType::Float32:
        return plyNumber<float>(bytes.data());
    case PlyType::Float64:
        break;
    }
    return plyNumber<double>(bytes.data());
}

} // namespace fathom
