// SPDX-License-Identifier: Apache-2.0
#include "devices/recorded/recording_intrinsics.h"

#include "devices/recorded/depth_scale.h"
#include "devices/recorded/foreign_field.h"
#include "devices/recorded/json_field.h"
#include "devices/recorded/lens_model.h"
#include "devices/recorded/recording_extrinsics.h"
#include "engine/types/decimation.h"
#include "engine/types/error.h"

#include <algorithm>
#include <numbers>

namespace fathom {

namespace {

void readDistortion(const JsonField& block, Intrinsics& lens) {
    const auto list = block.find("distortion"), model = block.find("distortion_model");
    refuseForeignDistortion(block);
    const std::vector<double> given = list ? list->numbers() : std::vector<double>{};
    const std::string allowed = setDistortion(lens, model ? model->text() : "", given);
    if (!allowed.empty()) {
        (allowed.starts_with("plumb_bob") && model ? *model : *list).refuse(allowed);
    }
}

void readPinhole(const JsonField& block, Intrinsics& lens) {
    const auto matrix = block.find("intrinsic_matrix"); // Open3D, column by column
    if (!matrix) {
        lens.fx = ownField(block, "fx").positive();
        lens.fy =
            ownField(block, "fy")
                .positive("; y points down here: give a negative fy without its sign; where y points up "
                          "in the world, too, as at ICL-NUIM, negate ty, qx and qz of poses.txt");
        lens.cx = ownField(block, "cx").finite();
        lens.cy = ownField(block, "cy").finite();
        return;
    }
    const std::vector<double> k = matrix->isNumbers() ? matrix->numbers() : std::vector<double>{};
    if (k.size() != 9 || !(k[0] > 0.0 && k[4] > 0.0) || k[8] != 1.0 || k[2] != 0.0 || k[5] != 0.0) {
        matrix->refuse("nine numbers in column-major order: fx, 0, 0, 0, fy, 0, cx, cy, 1");
    }
    lens.fx = k[0];
    lens.fy = k[4];
    lens.cx = k[6];
    lens.cy = k[7];
}

Intrinsics readLens(const JsonField& block, RecordingIntrinsics& intrinsics) {
    Intrinsics lens;
    lens.width = ownField(block, "width").integer(1, kMaxImageWidth);
    lens.height = ownField(block, "height").integer(1, kMaxImageHeight);
    readPinhole(block, lens);
    if (const auto matrix = block.find("intrinsic_matrix")) {
        warnAboutSkew(intrinsics.warnings, intrinsics.file + ": " + matrix->path(), matrix->numbers()[3]);
    }
    if (const auto skew = block.find("skew"); skew && skew->isNumber()) {
        warnAboutSkew(intrinsics.warnings, intrinsics.file + ": " + skew->path(), skew->finite());
    }
    readDistortion(block, lens);
    if (!lens.invertible()) {
        block.at("distortion").refuse("coefficients that can be inverted over the whole image");
    }
    return lens;
}

// Accepts British and American spelling.
std::optional<JsonField> findColour(const JsonField& node, std::string_view american,
                                    std::string_view british) {
    const auto found = node.find(american);
    return found ? found : node.find(british);
}

void readTwoLenses(const JsonField& root, const JsonField& colour, const std::string& file,
                   RecordingIntrinsics& intrinsics) {
    CameraInfo& camera = intrinsics.camera;
    camera.depth = readLens(root.at("depth"), intrinsics);
    camera.colour = readLens(colour, intrinsics);
    refuseSharedDistortion(root, root.at("depth"), colour);
    const auto registered = findColour(root, "registered_to_color", "registered_to_colour");
    camera.registered = registered && registered->boolean();
    if (!camera.registered) {
        camera.colourTdepth = readColourTdepth(root, file);
        return;
    }
    if (camera.colour.width != camera.depth.width || camera.colour.height != camera.depth.height) {
        registered->refuse("false (with extrinsics_topic_tf) where depth and colour differ in size");
    }
    if (!sameLens(camera.depth, camera.colour)) { // which of them the images have is not known
        registered->refuse("one lens, that of the images, where depth is registered to colour; or false with "
                           "extrinsics_topic_tf");
    }
}

void readOneLens(const JsonField& root, RecordingIntrinsics& intrinsics) {
    CameraInfo& camera = intrinsics.camera;
    camera.depth = readLens(root, intrinsics);
    camera.colour = camera.depth;
    camera.registered = true; // a single lens implies registration
    const auto registered = findColour(root, "registered_to_color", "registered_to_colour");
    if (registered && !registered->boolean()) {
        registered->refuse("true, or blocks depth and color with extrinsics_topic_tf");
    }
}

bool readWord(const JsonField& root, std::string_view key, std::string_view plain, std::string_view other) {
    const auto field = root.find(key);
    if (field && field->text() != plain && field->text() != other) {
        field->refuse(std::string(plain) + " or " + std::string(other));
    }
    return field && field->text() == other;
}

// Fields of sonars and laser scanners.
void readBeams(const JsonField& root, RecordingIntrinsics& intrinsics) {
    constexpr double kRadian = std::numbers::pi / 180.0, kWidest = 85.0 * kRadian;
    Intrinsics& lens = intrinsics.camera.depth;
    lens.fan = readWord(root, "projection", "pinhole", "equal_angles");
    const double across = std::max(lens.cx, lens.width - lens.cx) / lens.fx,
                 down = std::max(lens.cy, lens.height - lens.cy) / lens.fy;
    if (lens.fan && (lens.distorted() || across > kWidest || down > kWidest)) {
        root.at("projection").refuse("no distortion and beams within 85 degrees of the axis");
    }
    intrinsics.camera.colour.fan = intrinsics.camera.registered && lens.fan;
    intrinsics.rangeImages = readWord(root, "depth_is", "z", "range");
    if (const auto beam = root.find("beam")) {
        BeamSigma sigma;
        sigma.width = kRadian * beam->at("width_deg").finite();
        sigma.range = beam->at("sigma_m").finite();
        sigma.perMetre = beam->at("sigma_m_per_m").finite();
        if (!(sigma.width >= 0.0 && sigma.width < 1.0 && sigma.range >= 0.0 && sigma.perMetre >= 0.0)) {
            beam->refuse("numbers of at least 0, width_deg below 57");
        }
        intrinsics.camera.beam = sigma;
    }
}

void readStamps(const JsonField& root, RecordingIntrinsics& intrinsics) {
    const auto depth = root.find("depth_stamps_s");
    const auto colour = findColour(root, "color_stamps_s", "colour_stamps_s");
    if (!depth) {
        return;
    }
    intrinsics.depthStamps = depth->numbers();
    intrinsics.colourStamps = colour ? colour->numbers() : std::vector<double>{};
    if (const auto fps = root.find("nominal_fps")) {
        intrinsics.pairWithin = 0.5 / fps->positive();
    }
}

} // namespace

void keepRecordedColour(RecordingIntrinsics& given, const std::function<CameraInfo()>& recorded) {
    CameraInfo& camera = given.camera;
    if (given.relatesColour || !camera.hasColour) {
        return;
    }
    CameraInfo own;
    try {
        own = recorded();
    } catch (const BadInput& e) {
        throw BadInput(given.file, "registered_to_color", "missing",
                       std::string("true, or blocks depth and color, as the recording does not tell how "
                                   "colour relates to depth: ") +
                           e.what());
    }
    if (own.hasColour && !own.registered) {
        camera.registered = false;
        camera.colour = own.colour;
        camera.colourTdepth = own.colourTdepth;
    }
}

RecordingIntrinsics readIntrinsics(const std::filesystem::path& file, ScaleRule rule) {
    const nlohmann::json document = parseJsonFile(file);
    const JsonField root(document, file.string(), "");
    RecordingIntrinsics intrinsics;
    intrinsics.file = file.filename().string();
    CameraInfo& camera = intrinsics.camera;
    const auto colour = findColour(root, "color", "colour");
    const bool two = colour || root.find("depth");
    intrinsics.relatesColour = two || findColour(root, "registered_to_color", "registered_to_colour");
    if (two) {
        readTwoLenses(root, colour ? *colour : root.at("color"), file.string(), intrinsics);
    } else {
        readOneLens(root, intrinsics);
    }
    intrinsics.scale = statedScale(root, rule);
    intrinsics.unreadScale = intrinsics.scale ? "" : otherScale(root);
    intrinsics.unitWarning = intrinsics.scale ? twoScales(root, intrinsics.file, *intrinsics.scale) : "";
    camera.metresPerUnit = intrinsics.scale.value_or(camera.metresPerUnit);
    const auto colourThere = findColour(root, "has_color", "has_colour");
    camera.hasColour = !colourThere || colourThere->boolean();
    if (!camera.hasColour && !camera.registered) {
        colourThere->refuse("true where there is a block color");
    }
    if (const auto decimation = root.find("decimation")) {
        camera.decimation = decimation->integer(1, kMaxDecimation);
    }
    if (const auto water = root.find("port_corrected")) {
        camera.inWater = true;
        camera.sigma = water->at("sigma_m").finite();
        if (camera.sigma < 0.0) {
            water->at("sigma_m").refuse("at least 0");
        }
    }
    readBeams(root, intrinsics);
    readStamps(root, intrinsics);
    return intrinsics;
}

} // namespace fathom
