// SPDX-License-Identifier: Apache-2.0
// Header of a PLY file. Source: Greg Turk, "The PLY Polygon File Format" (1994); the names of an organised
// cloud's size: the PLY writer of the Point Cloud Library.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace fathom {

// Type of a property.
enum class PlyType : uint8_t { Int8, Uint8, Int16, Uint16, Int32, Uint32, Float32, Float64 };
// [bytes] in a binary file.
size_t plyBytes(PlyType type);
bool plyReal(PlyType type); // whether it is float or double

// One property of an element: a value, or a list with its number of values in front.
struct PlyProperty {
    std::string name;
    PlyType type = PlyType::Float32;
    bool list = false;
    PlyType countType = PlyType::Uint8;
};

// A run of records of one kind.
struct PlyElement {
    std::string name;
    uint64_t count = 0;
    std::vector<PlyProperty> properties;

    // Its place among the properties; properties.size() = there is none.
    size_t find(const std::string& property) const;
};

// How values are written.
enum class PlyFormat : uint8_t { Ascii, LittleEndian, BigEndian };

// What the header says.
struct PlyHeader {
    PlyFormat format = PlyFormat::Ascii;
    std::vector<PlyElement> elements;
    uint32_t width = 0, height = 0; // of an organised cloud, 0 = not stated
    size_t end = 0;                 // offset of the first value [bytes]
};

// At most 64 elements of 256 properties. Throws BadInput that names the file and the header's line.
PlyHeader plyHeader(const std::string& file, std::string_view text);

} // namespace fathom
