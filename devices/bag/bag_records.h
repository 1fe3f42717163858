// SPDX-License-Identifier: Apache-2.0
// Headers of the records of a ROS 1 bag: fields "name=value". Source: wiki.ros.org/Bags/Format/2.0.
#pragma once

#include "engine/types/error.h"

#include <cstdint>
#include <cstring>
#include <map>
#include <span>
#include <string>

namespace fathom::bag {

// Kinds of records: the field "op".
inline constexpr uint8_t kMessage = 2;
inline constexpr uint8_t kBagHeader = 3;
inline constexpr uint8_t kIndexData = 4;
inline constexpr uint8_t kChunk = 5;
inline constexpr uint8_t kChunkInfo = 6;
inline constexpr uint8_t kConnection = 7;
inline constexpr uint32_t kMaxBytes = 1u << 30; // of one record or chunk

using Fields = std::map<std::string, std::string>; // of a record's header, by name

// Throws Error for bytes that are no fields.
Fields parseFields(std::span<const uint8_t> bytes);

// A field of this size. Throws Error where it is missing or of another size.
template <class T>
T number(const Fields& fields, const char* name) {
    const auto it = fields.find(name);
    if (it == fields.end() || it->second.size() != sizeof(T)) {
        throw Error(std::string("a header without '") + name + "'");
    }
    T value;
    std::memcpy(&value, it->second.data(), sizeof(T));
    return value;
}

// A field as text on one line; empty where it is missing.
std::string word(const Fields& fields, const char* name);

} // namespace fathom::bag
