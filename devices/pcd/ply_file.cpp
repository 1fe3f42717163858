// SPDX-License-Identifier: Apache-2.0
#include "devices/pcd/ply_file.h"

#include "devices/pcd/colour_levels.h"
#include "devices/pcd/ply_values.h"
#include "engine/types/error.h"
#include "engine/types/number_text.h"
#include "engine/types/read_file.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace fathom {

namespace {

constexpr uint32_t kPlyWidth = 3840, kPlyHeight = 2160;
constexpr size_t kPlyFileBytes = size_t{1} << 30;
constexpr uint32_t kNoPoint = UINT32_MAX;

// Collects the elements of an organised cloud in the order of the file.
class PlyReader {
public:
    PlyReader(const std::string& file, std::string_view text)
        : head_(plyHeader(file, text))
        , values_(file, text, head_) {}

    PcdCloud read() {
        for (const PlyElement& element : head_.elements) {
            if (element.name == "vertex") {
                readVertices(element);
            } else if (element.name == "range_grid") {
                readGrid(element);
            } else {
                readOther(element);
            }
        }
        checkSize();
        return organised();
    }

private:
    // Where a record has x, y, z, and its colour or intensity; unused = past the end.
    struct Places {
        std::array<size_t, 3> point{}, colour{};
        size_t intensity = 0;
        bool coloured = false, real = false; // real: of its colour
    };

    Places placesOf(const PlyElement& vertex) const {
        Places places;
        const std::vector<PlyProperty>& all = vertex.properties;
        for (size_t i = 0; i < 3; ++i) {
            places.point[i] = vertex.find({"xyz"[i]});
            if (places.point[i] >= all.size() || all[places.point[i]].list ||
                !plyReal(all[places.point[i]].type)) {
                values_.refuse("element vertex", "no property " + std::string(1, "xyz"[i]) + " of type float",
                               "x, y and z of type float or double");
            }
        }
        const char* const kNames[3][3] = {
            {"red", "green", "blue"}, {"r", "g", "b"}, {"diffuse_red", "diffuse_green", "diffuse_blue"}};
        for (const auto& names : kNames) {
            places.colour = {vertex.find(names[0]), vertex.find(names[1]), vertex.find(names[2])};
            places.coloured = std::ranges::all_of(
                places.colour, [&](size_t at) { return at < all.size() && !all[at].list; });
            if (places.coloured) {
                places.real = plyReal(all[places.colour[0]].type);
                break;
            }
        }
        places.intensity = vertex.find("intensity");
        return places;
    }

    void readVertices(const PlyElement& vertex) {
        const Places places = placesOf(vertex);
        if (vertex.count > uint64_t{kPlyWidth} * kPlyHeight) {
            values_.refuse("element vertex", std::to_string(vertex.count), "at most 3840x2160 points");
        }
        std::vector<double> record(vertex.properties.size());
        std::vector<std::array<double, 3>> colours;
        for (uint64_t i = 0; i < vertex.count; ++i) {
            for (size_t p = 0; p < record.size(); ++p) {
                record[p] = values_.property(vertex.properties[p], vertex.name, i);
            }
            points_.push_back({record[places.point[0]], record[places.point[1]], record[places.point[2]]});
            if (places.coloured) {
                colours.push_back(
                    {record[places.colour[0]], record[places.colour[1]], record[places.colour[2]]});
            }
            if (places.intensity < record.size()) {
                intensity_.push_back(static_cast<float>(record[places.intensity]));
            }
        }
        double largest = 0.0;
        colours_ = packColours(colours, places.real, largest);
    }

    void readGrid(const PlyElement& grid) {
        if (grid.count > uint64_t{kPlyWidth} * kPlyHeight || grid.properties.size() != 1 ||
            !grid.properties[0].list) {
            values_.refuse("element range_grid", std::to_string(grid.count),
                           "at most 3840x2160 lists of vertex_indices");
        }
        for (uint64_t i = 0; i < grid.count; ++i) {
            const double index = values_.property(grid.properties[0], grid.name, i);
            if (!std::isnan(index) && !(index >= 0.0 && index < kNoPoint && index == std::floor(index))) {
                values_.refuse("element range_grid " + std::to_string(i), std::to_string(index),
                               "the number of a point");
            }
            grid_.push_back(std::isnan(index) ? kNoPoint : static_cast<uint32_t>(index));
        }
    }

    // The viewport of a camera is the cloud's size, where nothing else states it.
    void readOther(const PlyElement& element) {
        const size_t columns = element.find("viewportx"), rows = element.find("viewporty");
        if (element.properties.empty()) {
            return; // whatever their number, they take no bytes
        }
        std::vector<double> record(element.properties.size());
        for (uint64_t i = 0; i < element.count; ++i) {
            for (size_t p = 0; p < record.size(); ++p) {
                const double value = record[p] = values_.property(element.properties[p], element.name, i);
                uint32_t* to = p == columns ? &viewport_[0] : (p == rows ? &viewport_[1] : nullptr);
                if (element.name == "camera" && to != nullptr && value >= 1.0 && value <= kPlyWidth) {
                    *to = static_cast<uint32_t>(value);
                }
            }
            posed_ = posed_ || (element.name == "camera" && isPose(element, record));
        }
    }

    // Of a camera as the Point Cloud Library writes it; some writers leave its axes 0.
    static bool isPose(const PlyElement& camera, const std::vector<double>& record) {
        constexpr double kRounding = 1e-6;
        double apart = 0.0, turned = 0.0, axes = 0.0;
        const auto stated = [&](const std::string& name) {
            const size_t at = camera.find(name);
            return at < record.size() ? record[at] : 0.0;
        };
        for (const char of : {'x', 'y', 'z'}) {
            apart += std::abs(stated(std::string("view_p") + of));
            for (const char along : {'x', 'y', 'z'}) {
                const double value = stated(std::string{of} + "_axis" + along);
                turned += std::abs(value - (of == along ? 1.0 : 0.0));
                axes += std::abs(value);
            }
        }
        return !(apart <= kRounding) || (axes > 0.0 && !(turned <= kRounding));
    }

    void checkSize() {
        if (head_.width == 0 && head_.height == 0) {
            head_.width = viewport_[0];
            head_.height = viewport_[1];
        }
        if (head_.width < 2 || head_.height < 2 || head_.width > kPlyWidth || head_.height > kPlyHeight) {
            values_.refuse("num_cols, num_rows",
                           head_.width == 0 && head_.height == 0 ? "missing"
                                                                 : sizeText(head_.width, head_.height),
                           "an organised cloud of 2x2 to 3840x2160 points, its size stated in the header: "
                           "obj_info num_cols W, obj_info num_rows H");
        }
        const uint64_t pixels = uint64_t{head_.width} * head_.height;
        const uint64_t have = grid_.empty() ? points_.size() : grid_.size();
        if (have != pixels) {
            values_.refuse(grid_.empty() ? "element vertex" : "element range_grid", std::to_string(have),
                           "num_cols x num_rows: " + std::to_string(pixels));
        }
        const auto wrong = std::ranges::find_if(
            grid_, [&](uint32_t point) { return point != kNoPoint && point >= points_.size(); });
        if (wrong != grid_.end()) {
            values_.refuse("element range_grid " + std::to_string(wrong - grid_.begin()),
                           std::to_string(*wrong), "less than " + std::to_string(points_.size()));
        }
    }

    template <class T>
    std::vector<T> spread(std::vector<T> values, const T& none) const {
        if (grid_.empty() || values.empty()) {
            return values;
        }
        std::vector<T> out;
        out.reserve(grid_.size());
        for (const uint32_t point : grid_) {
            out.push_back(point == kNoPoint ? none : values[point]);
        }
        return out;
    }

    PcdCloud organised() {
        return {head_.width,
                head_.height,
                spread(std::move(points_), dvec3(NAN)),
                spread(std::move(colours_), 0xff000000u),
                spread(std::move(intensity_), NAN),
                {},
                posed_ ? "element camera" : ""};
    }

    PlyHeader head_;
    PlyValues values_;
    std::vector<dvec3> points_;
    std::vector<uint32_t> colours_, grid_;
    std::vector<float> intensity_;
    std::array<uint32_t, 2> viewport_{};
    bool posed_ = false; // by an element camera
};

} // namespace

PcdCloud readPlyCloud(const std::filesystem::path& file) {
    const std::string text = readWholeFile(file, kPlyFileBytes, "an organised PLY file");
    return PlyReader(file.string(), text).read();
}

} // namespace fathom
