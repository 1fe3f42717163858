// SPDX-License-Identifier: Apache-2.0
#include "tests/rig/small_recording.h"

#include <cmath>
#include <fstream>
#include <iomanip>
#include <png.h>
#include <sstream>

namespace fathom {

namespace {

std::string sixDigits(size_t number) {
    std::string digits = std::to_string(number);
    return std::string(6 - digits.size(), '0') + digits;
}

void putText(const std::filesystem::path& file, const std::string& text) {
    std::ofstream(file, std::ios::binary) << text;
}

void writeDepthImage(const std::filesystem::path& file, const Image& image) {
    std::vector<uint8_t> bytes;
    for (uint16_t value : image.depth) {
        bytes.push_back(static_cast<uint8_t>(value >> 8));
        bytes.push_back(static_cast<uint8_t>(value & 255));
    }
    writePng(file, image.width, image.height, 16, PNG_COLOR_TYPE_GRAY, bytes);
}

void writeColourImage(const std::filesystem::path& file, const Image& image) {
    std::vector<uint8_t> bytes;
    for (const Paint3& paint : image.colour) {
        bytes.insert(bytes.end(), {paint.r, paint.g, paint.b});
    }
    writePng(file, image.width, image.height, 8, PNG_COLOR_TYPE_RGB, bytes);
}

} // namespace

Image& Image::paint(const PixelBox& box, const Paint3& paint) {
    for (uint32_t v = box.v0; v < box.v1; ++v) {
        std::fill_n(colour.begin() + v * width + box.u0, box.u1 - box.u0, paint);
    }
    return *this;
}

Image& Image::set(const PixelBox& box, uint16_t millimetres) {
    for (uint32_t v = box.v0; v < box.v1; ++v) {
        std::fill_n(depth.begin() + v * width + box.u0, box.u1 - box.u0, millimetres);
    }
    return *this;
}

Image& Image::dome(const PixelBox& box, double millimetres) {
    for (uint32_t v = box.v0; v < box.v1; ++v) {
        for (uint32_t u = box.u0; u < box.u1; ++u) {
            const double x = (2.0 * (u - box.u0) + 1.0) / (box.u1 - box.u0) - 1.0;
            const double y = (2.0 * (v - box.v0) + 1.0) / (box.v1 - box.v0) - 1.0;
            const double lift = millimetres * std::sqrt(std::max(0.0, 1.0 - x * x - y * y));
            depth[v * width + u] = static_cast<uint16_t>(depth[v * width + u] - std::lround(lift));
        }
    }
    return *this;
}

std::string lensJson(uint32_t width, uint32_t height) {
    std::ostringstream text;
    text << "{\"width\": " << width << ", \"height\": " << height << ", \"fx\": " << kFocal
         << ", \"fy\": " << kFocal << ",\n \"cx\": " << (width - 1) / 2.0
         << ", \"cy\": " << (height - 1) / 2.0
         << ", \"distortion_model\": \"none\", \"distortion\": [],\n"
            " \"depth_scale_m_per_unit\": 0.001, \"registered_to_color\": true}\n";
    return text.str();
}

void writeRecording(const std::filesystem::path& folder, const std::vector<Image>& images) {
    std::filesystem::create_directories(folder);
    std::ostringstream index;
    index << "# t_rgb rgb t_depth depth\n" << std::fixed << std::setprecision(6);
    for (size_t i = 0; i < images.size(); ++i) {
        const std::string name = sixDigits(i) + ".png";
        const double t = static_cast<double>(i) / 30.0;
        writeDepthImage(folder / "depth" / name, images[i]);
        writeColourImage(folder / "rgb" / name, images[i]);
        index << t << " rgb/" << name << " " << t << " depth/" << name << "\n";
    }
    putText(folder / "associations.txt", index.str());
    putText(folder / "intrinsics.json", lensJson(images.at(0).width, images.at(0).height));
}

Image bumpImage() {
    Image image(kWidth, kHeight, 600);
    return image.dome({24, 14, 44, 34}, 60.0).paint({24, 14, 44, 34}, kRed).paint({4, 16, 14, 30}, kYellow);
}

std::string SceneText::text() const {
    std::ostringstream all;
    const auto section = [&all](const char* name, const std::string& body) {
        if (!body.empty()) {
            all << name << ": { " << body << " }\n";
        }
    };
    section("camera", camera);
    section("filter", filter);
    all << "fixtures:" << (fixtures.empty() ? " []" : "") << "\n";
    for (const std::string& row : fixtures) {
        all << "  - { " << row << " }\n";
    }
    section("tool", tool);
    section("hand", hand);
    section("haptics", haptics);
    section("contact", contact);
    all << more;
    return all.str();
}

std::string handCsv(const std::vector<HandRow>& rows) {
    std::ostringstream text;
    text << "t_s,x,y,z,qw,qx,qy,qz,button\n" << std::setprecision(17);
    for (const HandRow& row : rows) {
        text << row.t;
        for (double value : row.at) {
            text << "," << value;
        }
        for (double value : row.wxyz) {
            text << "," << value;
        }
        text << "," << row.buttons << "\n";
    }
    return text.str();
}

} // namespace fathom
