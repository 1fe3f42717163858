// SPDX-License-Identifier: Apache-2.0
#include "devices/pcd/colour_fields.h"

#include "devices/pcd/colour_levels.h"

#include <algorithm>
#include <cstring>
#include <string>

namespace fathom {

namespace {

// use(point) in order of rows.
template <class Use>
void eachPoint(const PointRows& points, Use&& use) {
    for (size_t v = 0; v < points.height; ++v) {
        const uint8_t* point = points.first + v * points.rowStep;
        for (uint32_t u = 0; u < points.width; ++u, point += points.pointStep) {
            use(point);
        }
    }
}

} // namespace

ColourFields::ColourFields(std::span<const PcdField> fields) {
    const PcdField* rgb = fieldNamed(fields, "rgb");
    rgb = rgb != nullptr ? rgb : fieldNamed(fields, "rgba");
    if (rgb != nullptr && rgb->count <= 1 && rgb->size == 4) { // an integer, or the bits of a float
        packed_ = rgb;
        return;
    }
    std::array<Level, 3> levels{};
    if (rgb != nullptr && rgb->count >= 3) {
        levels = {Level{rgb, 0}, Level{rgb, 1}, Level{rgb, 2}};
    }
    const char* const kNames[2][3] = {{"r", "g", "b"}, {"red", "green", "blue"}};
    for (const auto& names : kNames) {
        for (size_t c = 0; c < 3; ++c) {
            levels[c].field = levels[c].field != nullptr ? levels[c].field : fieldNamed(fields, names[c]);
        }
    }
    if (std::ranges::all_of(levels,
                            [](const Level& l) { return l.field != nullptr && l.field->isNumber(); })) {
        levels_ = levels;
        real_ = std::ranges::any_of(levels, [](const Level& l) { return l.field->type == 'F'; });
    }
}

std::vector<uint32_t> ColourFields::readPacked(const PointRows& points) const {
    std::vector<uint32_t> colours;
    colours.reserve(size_t{points.width} * points.height);
    eachPoint(points, [&](const uint8_t* point) {
        uint32_t bits = 0;
        std::memcpy(&bits, point + packed_->offset, sizeof bits);
        bits = points.bigEndian ? __builtin_bswap32(bits) : bits;
        colours.push_back(0xff000000u | (bits & 0xff) << 16 | (bits & 0xff00) | (bits >> 16 & 0xff));
    });
    return colours;
}

std::vector<uint32_t> ColourFields::read(const PointRows& points, double& largest) const {
    if (packed_ != nullptr) {
        return readPacked(points);
    }
    std::vector<std::array<double, 3>> colours;
    if (levels_[2].field != nullptr) {
        colours.reserve(size_t{points.width} * points.height);
        eachPoint(points, [&](const uint8_t* point) {
            const auto at = [&](const Level& l) { return l.field->at(point, l.value, points.bigEndian); };
            colours.push_back({at(levels_[0]), at(levels_[1]), at(levels_[2])});
        });
    }
    return packColours(colours, real_, largest);
}

std::string whyUncoloured(std::span<const PcdField> fields) {
    constexpr size_t kMaxNamed = 12, kLongestName = 40;
    std::string all;
    for (const PcdField& field : fields.first(std::min(fields.size(), kMaxNamed))) {
        all += (all.empty() ? "" : ", ") + field.name.substr(0, kLongestName) + ' ' + field.type +
               std::to_string(field.size) + (field.count > 1 ? " x " + std::to_string(field.count) : "");
    }
    return "no colour is read from the fields " + all + (fields.size() > kMaxNamed ? " and more" : "") +
           " (read are rgb or rgba of 4 bytes or three values, or r, g, b up to 65535)";
}

} // namespace fathom
