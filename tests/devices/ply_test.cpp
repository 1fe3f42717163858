// SPDX-License-Identifier: Apache-2.0
// Organised PLY files, with headers as the Point Cloud Library writes them.
#include "devices/pcd/pcd_camera.h"
#include "tests/devices/organised_cloud.h"
#include "tests/devices/recorded_folder.h"
#include "tests/support/refusal.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <doctest/doctest.h>

using namespace fathom;

namespace {

constexpr uint32_t kPlyColumns = 9, kPlyRows = 7, kPlyPixels = kPlyColumns * kPlyRows;

// Appends values as a format writes them.
class PlyText {
public:
    explicit PlyText(std::string format)
        : format_(std::move(format)) {}

    template <class T>
    void add(T value) {
        if (format_ == "ascii") {
            text_ += std::to_string(value) + " ";
            return;
        }
        std::string bytes(sizeof value, ' ');
        std::memcpy(bytes.data(), &value, sizeof value);
        if (format_ == "binary_big_endian") {
            std::reverse(bytes.begin(), bytes.end());
        }
        text_ += bytes;
    }
    void line() { text_ += format_ == "ascii" ? "\n" : ""; }
    const std::string& text() const { return text_; }

private:
    std::string format_, text_;
};

// Pixel i of a wall at 1 m, tilted, seen by a pinhole; pixel 0 has no point. Real: float or double.
template <class Real>
void addVertex(PlyText& out, uint32_t i) {
    const uint32_t u = i % kPlyColumns, v = i / kPlyColumns;
    const double z = i == 0 ? NAN : 1.0 + 0.05 * u;
    for (const double value : {(u - 4.25) / 10.0 * z, (v - 3.5) / 11.0 * z, z}) {
        out.add(static_cast<Real>(value));
    }
    for (const uint32_t level : {0x10u, 0x20u, 0x30u + i}) {
        out.add(static_cast<uint8_t>(level));
    }
    out.line();
}

std::string vertexLines(uint32_t count, const char* real) {
    std::string text = "element vertex " + std::to_string(count) + "\n";
    for (const char* axis : {"x", "y", "z"}) {
        text += std::string("property ") + real + " " + axis + "\n";
    }
    return text + "property uchar red\nproperty uchar green\nproperty uchar blue\nelement face 0\n";
}

constexpr const char* kPlySize = "obj_info num_cols 9\nobj_info num_rows 7\n";

// Only measured points are vertices, and a grid says where they are.
std::string gridded(const std::string& format) {
    PlyText values(format);
    for (uint32_t i = 1; i < kPlyPixels; ++i) {
        addVertex<float>(values, i);
    }
    for (uint32_t i = 0; i < kPlyPixels; ++i) {
        values.add(static_cast<uint8_t>(i == 0 ? 0 : 1));
        if (i > 0) {
            values.add(static_cast<int32_t>(i - 1));
        }
        values.line();
    }
    return "ply\nformat " + format + " 1.0\ncomment PCL generated\n" + kPlySize +
           vertexLines(kPlyPixels - 1, "float") +
           "element range_grid 63\nproperty list uchar int vertex_indices\nend_header\n" + values.text();
}

// Every pixel is a vertex.
std::string whole(const std::string& format, const std::string& size) {
    PlyText values(format);
    for (uint32_t i = 0; i < kPlyPixels; ++i) {
        addVertex<double>(values, i);
    }
    return "ply\nformat " + format + " 1.0\n" + size + vertexLines(kPlyPixels, "double") + "end_header\n" +
           values.text();
}

// Every pixel is a vertex, and a camera has the size.
std::string withCamera(const std::string& format) {
    PlyText values(format);
    for (uint32_t i = 0; i < kPlyPixels; ++i) {
        addVertex<float>(values, i);
    }
    values.add(1.5f);
    values.add(static_cast<int32_t>(kPlyColumns));
    values.add(static_cast<int32_t>(kPlyRows));
    return "ply\nformat " + format + " 1.0\n" + vertexLines(kPlyPixels, "float") +
           "element camera 1\nproperty float focal\nproperty int viewportx\nproperty int viewporty\n"
           "end_header\n" +
           values.text();
}

std::string plyRefusal(const std::string& text) {
    const TemporaryFolder folder;
    folder.write("x.ply", text);
    return testing::refusalOf([&] { PcdCamera camera(folder.path() / "x.ply"); });
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
    return text.replace(text.find(from), from.size(), to);
}

} // namespace

TEST_CASE("An organised PLY gives its lens, depth and colour in every format, by grid, size or camera") {
    const TemporaryFolder folder;
    for (const char* format : {"ascii", "binary_little_endian", "binary_big_endian"}) {
        for (const std::string& text : {gridded(format), whole(format, kPlySize), withCamera(format),
                                        whole(format, "comment width: 9\ncomment height: 7\n"),
                                        whole(format, "comment Width=9\ncomment Height=7\n")}) {
            folder.write("cloud", text); // its first bytes say that it is PLY
            testing::checkOrganisedCloud(folder.path() / "cloud");
        }
    }
}

TEST_CASE("Colours of a PLY in more than a byte are levels of 0 to 255 where none is larger") {
    const TemporaryFolder folder;
    for (const char* type : {"ushort", "short", "int", "uint"}) {
        std::string text = whole("ascii", kPlySize);
        for (const char* colour : {" red", " green", " blue"}) {
            text = replaced(text, std::string("uchar") + colour, type + std::string(colour));
        }
        folder.write("a.ply", text);
        testing::checkOrganisedCloud(folder.path() / "a.ply");
    }
}

TEST_CASE("A PLY that is unorganised, truncated or contradicts its size is rejected with the line") {
    const std::string good = gridded("binary_big_endian");
    CHECK(plyRefusal(good).empty());
    CHECK(plyRefusal(whole("ascii", "")).find("x.ply: num_cols, num_rows: missing (allowed: an organised") !=
          std::string::npos);
    CHECK(plyRefusal(replaced(good, "num_rows 7", "num_rows 1")).find("9x1") != std::string::npos);
    CHECK(plyRefusal(replaced(good, "num_rows 7", "num_rows 8"))
              .find("element range_grid: 63 (allowed: num_cols x num_rows: 72)") != std::string::npos);
    CHECK(
        plyRefusal(whole("ascii", "obj_info num_cols 9\nobj_info num_rows 8\n")).find("element vertex: 63") !=
        std::string::npos);
    CHECK(plyRefusal(good.substr(0, good.size() - 1)).find("element range_grid: ends at 62") !=
          std::string::npos);
    CHECK(plyRefusal(replaced(good, "vertex 62", "vertex 99999999999")).find("at most 3840x2160") !=
          std::string::npos);
    CHECK(plyRefusal(replaced(good, "binary_big_endian", "binary_middle_endian")).find("format: binary_m") !=
          std::string::npos);
    CHECK(plyRefusal(replaced(good, "property float x", "property int x")).find("no property x") !=
          std::string::npos);
    CHECK(plyRefusal(replaced(good, "property float y", "property half y")).find("property: half") !=
          std::string::npos);
    CHECK(plyRefusal("ply\nformat ascii 1.0\n").find("header: cut off") != std::string::npos);
    CHECK(plyRefusal("ply\nend_header\n").find("format: missing") != std::string::npos);
    CHECK(plyRefusal(replaced(whole("ascii", kPlySize), "end_header\n", "end_header\n0x1p3 "))
              .find("element vertex 0: 0x1p3 (allowed: numbers)") != std::string::npos);
}

TEST_CASE("A grid of a PLY that names points or lists beyond the file is rejected") {
    std::string text = gridded("binary_little_endian");
    const size_t last = text.size() - 4;
    text.replace(last, 4, std::string("\xff\xff\x00\x00", 4));
    CHECK(plyRefusal(text).find("element range_grid 62: 65535 (allowed: less than 62)") != std::string::npos);
    text.replace(last, 4, std::string("\xff\xff\xff\xff", 4));
    CHECK(plyRefusal(text).find("the number of a point") != std::string::npos);
    const std::string lists = replaced(gridded("ascii"), "end_header\n", "end_header\n") + "";
    CHECK(plyRefusal(replaced(replaced(lists, "element face 0", "element face 1\nproperty list int int v"),
                              "\n0 \n", "\n99999999999 0 \n"))
              .find("fits the file") != std::string::npos);
    CHECK(plyRefusal(replaced(lists, "element face 0", "element face 18446744073709551615")).empty());
}

TEST_CASE("A PLY whose element camera has a pose has one warning, as the scene's pose counts") {
    const auto warned = [](const std::string& position, const std::string& axes) {
        std::string fields;
        for (const char* name : {"view_px", "view_py", "view_pz", "x_axisx", "x_axisy", "x_axisz", "y_axisx",
                                 "y_axisy", "y_axisz", "z_axisx", "z_axisy", "z_axisz"}) {
            fields += std::string("property float ") + name + "\n";
        }
        const TemporaryFolder folder;
        folder.write("x.ply", replaced(withCamera("ascii"), "end_header\n",
                                       "element camera 1\n" + fields + "end_header\n") +
                                  "\n" + position + axes + "\n");
        return PcdCamera(folder.path() / "x.ply").warnings();
    };
    const std::string identity = "1 0 0 0 1 0 0 0 1", none = "0 0 0 0 0 0 0 0 0";
    for (const std::string& axes : {identity, none}) {
        CHECK(warned("0 0 0 ", axes).empty());
        const std::vector<std::string> moved = warned("1 2 3 ", axes);
        REQUIRE(moved.size() == 1);
        CHECK(moved[0] == "the pose in element camera is not read: base_T_camera of the scene counts");
    }
    CHECK(warned("0 0 0 ", "0 0 -1 0 1 0 1 0 0").size() == 1);
}
