// SPDX-License-Identifier: Apache-2.0
#include "apps/convert/regions_ply.h"

#include "devices/bag/byte_cursor.h"
#include "devices/recorded/text_file.h"
#include "engine/types/read_file.h"

namespace fathom {

namespace {

constexpr size_t kVertex = 4 * sizeof(double) + 2 * sizeof(int32_t);
constexpr size_t kMaxRegionBytes = 1u << 30; // two spheres for each pixel of 3840x2160 have 0.7 GiB
constexpr std::string_view kPlyEnd = "end_header\n", kPlyCount = "element vertex ",
                           kPlyFields = "property double x\nproperty double y\nproperty double z\n"
                                        "property double radius\nproperty int class\nproperty int held\n";

// Number of vertices; empty when the header is of another kind.
std::optional<uint32_t> vertices(std::string_view header) {
    const size_t at = header.find(kPlyCount);
    uint32_t count = 0;
    if (!header.starts_with("ply\nformat binary_little_endian 1.0\n") || at == std::string_view::npos ||
        header.find(kPlyFields) == std::string_view::npos) {
        return std::nullopt;
    }
    const std::string_view rest = header.substr(at + kPlyCount.size());
    return parseNumber(rest.substr(0, rest.find('\n')), count) ? std::optional(count) : std::nullopt;
}

} // namespace

std::vector<ros2::RegionPoint> readRegionsPly(const std::filesystem::path& file) {
    const std::string text = readWholeFile(file, kMaxRegionBytes, "a file of replay --save-fixtures");
    const size_t end = std::min(text.find(kPlyEnd), text.size());
    const auto count = vertices(std::string_view(text).substr(0, end));
    const size_t begin = std::min(end + kPlyEnd.size(), text.size());
    if (!count || text.size() - begin != kVertex * *count) {
        throw BadInput(file.string(), "content", count ? "cut off" : "another kind",
                       "region spheres of replay --save-fixtures");
    }
    ByteCursor cursor({reinterpret_cast<const uint8_t*>(text.data()) + begin, text.size() - begin});
    std::vector<ros2::RegionPoint> points(*count);
    for (ros2::RegionPoint& point : points) {
        for (float* value : {&point.x, &point.y, &point.z, &point.radius}) {
            *value = static_cast<float>(cursor.real());
        }
        point.fixture = static_cast<float>(cursor.value<int32_t>());
        cursor.word(); // held or not
    }
    return points;
}

} // namespace fathom
