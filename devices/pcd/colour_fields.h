// SPDX-License-Identifier: Apache-2.0
// Which fields of a cloud's points hold colour, for PCD files and PointCloud2.
#pragma once

#include "devices/pcd/pcd_field.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace fathom {

// Points in memory, row by row.
struct PointRows {
    const uint8_t* first = nullptr;
    uint32_t width = 0, height = 0;
    size_t pointStep = 0, rowStep = 0; // [bytes]
    bool bigEndian = false;
};

// The fields `rgb` or `rgba` of four bytes (0xAARRGGBB) or of three values, or one field each of r, g, b or
// red, green, blue. Refers to the fields that it is made from.
class ColourFields {
public:
    explicit ColourFields(std::span<const PcdField> fields);
    explicit operator bool() const { return packed_ != nullptr || levels_[2].field != nullptr; }
    // 0xAABBGGRR of all points, which have all of the fields. largest: the largest level so far, by which
    // separate levels are scaled (packColours()); grows. Empty for levels of an unknown full scale.
    std::vector<uint32_t> read(const PointRows& points, double& largest) const;

private:
    // A red, green or blue value.
    struct Level {
        const PcdField* field = nullptr;
        size_t value = 0; // of its `count`
    };
    std::vector<uint32_t> readPacked(const PointRows& points) const;

    const PcdField* packed_ = nullptr;
    std::array<Level, 3> levels_{};
    bool real_ = false;
};

// Why fields hold no colour that is read: "no colour is read from the fields x F4, y F4, z F4 (read are
// ...)".
std::string whyUncoloured(std::span<const PcdField> fields);

} // namespace fathom
