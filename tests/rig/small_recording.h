// SPDX-License-Identifier: Apache-2.0
// Small recordings and scene files that tests write: a wall at one depth, with painted areas.
#pragma once

#include "tests/devices/recorded_folder.h"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace fathom {

struct Paint3 {
    uint8_t r, g, b;
};
inline constexpr Paint3 kGrey{128, 128, 128};  // no hue
inline constexpr Paint3 kRed{200, 20, 20};     // hue 0
inline constexpr Paint3 kYellow{200, 180, 20}; // hue 53

struct PixelBox { // [from, to)
    uint32_t u0, v0, u1, v1;
};

// A depth and a colour image. Depth in millimetres.
struct Image {
    uint32_t width, height;
    std::vector<uint16_t> depth;
    std::vector<Paint3> colour;

    Image(uint32_t w, uint32_t h, uint16_t millimetres)
        : width(w)
        , height(h)
        , depth(w * h, millimetres)
        , colour(w * h, kGrey) {}
    Image& paint(const PixelBox& box, const Paint3& paint);
    Image& set(const PixelBox& box, uint16_t millimetres);
    // Lifts the box towards the camera like part of a ball: its middle by `millimetres`, its edges by
    // nothing.
    Image& dome(const PixelBox& box, double millimetres);
};

// Intrinsics of these tests: 64x48 pixels, focal length 60 pixels, principal point in the middle.
inline constexpr uint32_t kWidth = 64, kHeight = 48;
inline constexpr double kFocal = 60.0, kCx = 31.5, kCy = 23.5;
std::string lensJson(uint32_t width, uint32_t height);

// Writes frames from 0 with stamps i / 30 s, associations.txt, and intrinsics.json for the size of the first
// frame.
void writeRecording(const std::filesystem::path& folder, const std::vector<Image>& images);

// A grey wall 600 mm away with a red bump of 60 mm in the middle and a yellow square on the left.
Image bumpImage();

// Sections of a scene file; an empty one uses the program's default. `fixtures` is a list of rows in braces.
struct SceneText {
    std::string camera = "near: 0.1, far: 3.0";
    std::vector<std::string> fixtures{kForbidRed};
    std::string tool = "spheres: [[0, 0, 0, 0.01]]";
    std::string hand, haptics, contact, filter;
    std::string more; // further lines

    static constexpr const char* kForbidRed =
        "name: red, role: forbidden, hue: [345, 20], saturation: [0.4, 1], radius: 0.04";
    static constexpr const char* kGuideYellow =
        "name: yellow, role: guidance, hue: [40, 70], saturation: [0.4, 1], min_count: 10";

    std::string text() const;
};

// One row of a hand path.
struct HandRow {
    double t;
    std::array<double, 3> at;
    std::array<double, 4> wxyz{1.0, 0.0, 0.0, 0.0};
    uint32_t buttons = 0;
};
std::string handCsv(const std::vector<HandRow>& rows);

} // namespace fathom
