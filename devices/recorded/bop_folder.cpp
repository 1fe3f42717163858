// SPDX-License-Identifier: Apache-2.0
#include "devices/recorded/bop_folder.h"

#include "devices/images/depth_image.h"
#include "devices/recorded/depth_scale.h"
#include "devices/recorded/json_field.h"
#include "devices/recorded/lens_model.h"
#include "devices/recorded/matrix_file.h"
#include "devices/recorded/numbered_images.h"
#include "devices/recorded/text_file.h"
#include "engine/types/error.h"
#include "engine/types/number_text.h"

#include <algorithm>
#include <map>

namespace fathom {

namespace {

namespace fs = std::filesystem;

struct BopImage {
    std::string key;           // its number in the file
    std::array<double, 9> k{}; // row by row
    double unit = 0.0;         // [mm]
    std::optional<Pose> baseTcamera;
};

// By number.
std::map<std::string, BopImage> bopImages(const fs::path& file) {
    const nlohmann::json document = parseJsonFile(file);
    const JsonField root(document, file.string(), "");
    std::map<std::string, BopImage> images;
    for (const auto& [key, unused] : document.items()) {
        uint32_t number = 0;
        if (!parseNumber(std::string_view(key), number)) {
            throw BadInput(file.string(), key, "not a number", "numbers of images");
        }
        const JsonField entry = root.at(key);
        BopImage image;
        image.key = key;
        if (entry.find("cam_model") && !entry.find("cam_K")) { // HOT3D
            throw BadInput(file.string(), key + ".cam_K", "missing",
                           std::string("cam_K row by row, ") + kLensRows + "; cam_model is not read");
        }
        const std::vector<double> k = entry.at("cam_K").numbers(9);
        std::copy(k.begin(), k.end(), image.k.begin());
        image.unit = entry.at("depth_scale").positive();
        const auto rotation = entry.find("cam_R_w2c"), position = entry.find("cam_t_w2c");
        if (rotation && position) {
            const std::vector<double> r = rotation->numbers(9), t = position->numbers(3);
            std::array<double, 9> rows{};
            std::copy(r.begin(), r.end(), rows.begin());
            image.baseTcamera = inverse(poseFromRows(rows, dvec3(t[0], t[1], t[2]) * 1e-3, file.string(),
                                                     key + ".cam_R_w2c")); // world to camera [mm]
        }
        images.emplace(std::to_string(number), image);
    }
    return images;
}

RecordingIntrinsics lensOf(const BopImage& image, PngSize size, const std::string& file) {
    RecordingIntrinsics intrinsics;
    if (const std::string fault = lensFault(image.k); !fault.empty()) {
        throw BadInput(file, image.key + ".cam_K", fault, std::string("row by row, ") + kLensRows);
    }
    if (size.width < 1 || size.width > kMaxImageWidth || size.height > kMaxImageHeight) {
        throw BadInput(file, image.key + ".cam_K", "for images of " + sizeText(size.width, size.height),
                       "images of at most 3840x2160");
    }
    CameraInfo& camera = intrinsics.camera;
    camera.depth.width = size.width;
    camera.depth.height = size.height;
    camera.depth.fx = image.k[0];
    camera.depth.fy = image.k[4];
    camera.depth.cx = image.k[2];
    camera.depth.cy = image.k[5];
    camera.colour = camera.depth;
    const std::string matrix = "scene_camera.json: cam_K";
    warnAboutSkew(intrinsics.warnings, matrix, image.k[1]);
    warnAboutSize(intrinsics.warnings, matrix, camera.depth);
    return intrinsics;
}

double metresPerUnitOf(const BopImage& image, const std::string& file) {
    const double unit = 1e-3 * image.unit;
    if (unit < kFinestUnit || unit > kCoarsestUnit) {
        throw BadInput(file, "depth_scale", significant(image.unit, 6), "millimetres per unit, 0.001 to 100");
    }
    return unit;
}

} // namespace

RecordingLayout readBop(const LayoutRequest& request) {
    const fs::path file = request.folder / "scene_camera.json";
    const std::map<std::string, BopImage> images = bopImages(file);
    RecordingLayout layout;
    layout.index = pairByNumber({request.folder / "depth", kDepthEndings},
                                {request.folder / "rgb", kColourEndings}, request.depthOnly);
    std::optional<BopImage> first;
    for (IndexLine& entry : layout.index) {
        const std::string number = imageNumber(entry.depth);
        const auto image = images.find(number);
        if (image == images.end()) {
            entry.fault = "scene_camera.json has no image " + number;
            continue;
        }
        first = first ? first : std::optional(image->second);
        if ((!request.lens && image->second.k != first->k) || image->second.unit != first->unit) {
            entry.fault = "lens or depth_scale differs from the first image";
        }
        entry.baseTcamera = image->second.baseTcamera;
        layout.posePerImage |= entry.baseTcamera.has_value();
    }
    if (!first) {
        throw BadInput(file.string(), "numbers of images", "none of a depth image", "those of depth/");
    }
    layout.intrinsics =
        request.lens ? *request.lens : lensOf(*first, firstDepthSize(layout.index), file.string());
    const auto unit = [&] { return metresPerUnitOf(*first, file.string()); };
    if (request.lens) {
        keepRecordedUnit(layout.intrinsics, file.filename().string(), unit);
    } else {
        layout.intrinsics.scale = layout.intrinsics.camera.metresPerUnit = unit();
    }
    return layout;
}

} // namespace fathom
