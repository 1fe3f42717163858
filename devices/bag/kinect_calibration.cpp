// SPDX-License-Identifier: Apache-2.0
#include "devices/bag/kinect_calibration.h"

#include "devices/bag/ros_messages.h"
#include "devices/recorded/lens_model.h"
#include "engine/types/error.h"
#include "engine/types/number_text.h"

#include <algorithm>

namespace fathom {

namespace {

constexpr const char* kDepthCamera = "CALIBRATION_CameraLocationD0";
constexpr const char* kColourCamera = "CALIBRATION_CameraLocationPV0";
constexpr const char* kBrownConrady = "CALIBRATION_LensDistortionModelBrownConrady";
constexpr size_t kParameters = 14;
constexpr size_t kMaxCameras = 16;
constexpr uint32_t kDepthSensor = 1024, kMaxSensor = 65535; // [pixels]

JsonField cameraAt(const nlohmann::json& cameras, const std::string& file, const char* location) {
    for (size_t i = 0; i < std::min(kMaxCameras, cameras.size()); ++i) {
        const JsonField camera(cameras[i], file, "CalibrationInformation.Cameras[" + std::to_string(i) + "]");
        if (camera.at("Location").text() == location) {
            return camera;
        }
    }
    throw BadInput(file, "CalibrationInformation.Cameras", "no camera at " + std::string(location),
                   "the calibration of an Azure Kinect");
}

} // namespace

KinectCalibration::KinectCalibration(const std::vector<uint8_t>& json, const std::string& file) {
    const nlohmann::json document = nlohmann::json::parse(json.begin(), json.end(), nullptr, false);
    if (document.is_discarded()) {
        throw BadInput(file, "content", "not JSON", "the calibration of an Azure Kinect");
    }
    const JsonField cameras = JsonField(document, file, "").at("CalibrationInformation").at("Cameras");
    const nlohmann::json& list = document["CalibrationInformation"]["Cameras"];
    if (!list.is_array()) {
        cameras.refuse("a list");
    }
    depth_ = sensor(cameraAt(list, file, kDepthCamera));
    colour_ = sensor(cameraAt(list, file, kColourCamera));
    colourTdepth_ = colour_.pose * inverse(depth_.pose);
}

KinectCalibration::Sensor KinectCalibration::sensor(const JsonField& camera) {
    Sensor out;
    out.width = camera.at("SensorWidth").integer(1, kMaxSensor);
    out.height = camera.at("SensorHeight").integer(1, kMaxSensor);
    const JsonField lens = camera.at("Intrinsics");
    out.model = lens.at("ModelType").text();
    out.parameters = lens.at("ModelParameters").numbers();
    if (out.parameters.size() < kParameters) {
        lens.at("ModelParameters").refuse("at least 14 numbers");
    }
    const JsonField pose = camera.at("Rt");
    const std::vector<double> r = pose.at("Rotation").numbers(9), t = pose.at("Translation").numbers(3);
    try {
        out.pose =
            ros::poseFromColumns({r[0], r[3], r[6], r[1], r[4], r[7], r[2], r[5], r[8]}, {t[0], t[1], t[2]});
    } catch (const Error&) {
        pose.at("Rotation").refuse("a rotation, row by row");
    }
    return out;
}

Intrinsics KinectCalibration::lensOf(const Sensor& sensor, const Window& window, uint32_t width,
                                     uint32_t height) {
    const std::vector<double>& p = sensor.parameters;
    Intrinsics lens;
    lens.width = width;
    lens.height = height;
    lens.fx = p[2] * window.binnedWidth;
    lens.fy = p[3] * window.binnedHeight;
    // From the corner of the first pixel to its centre.
    lens.cx = p[0] * window.binnedWidth - window.left - 0.5;
    lens.cy = p[1] * window.binnedHeight - window.top - 0.5;
    const bool centred = p[10] == 0.0 && p[11] == 0.0, bent = p[12] != 0.0 || p[13] != 0.0;
    // The model of early devices, Rational6KT, has another tangential part.
    if (!centred || (sensor.model != kBrownConrady && bent)) {
        throw Error("lens model " + sensor.model + (centred ? "" : " with a centre of distortion") +
                    " is not read (allowed: " + kBrownConrady + ")");
    }
    const std::vector<double> k{p[4], p[5], p[13], p[12], p[6], p[7], p[8], p[9]};
    const std::string allowed = setDistortion(lens, "rational_polynomial", k);
    if (!allowed.empty()) {
        throw Error("lens model " + sensor.model + " (allowed: " + allowed + ")");
    }
    return lens;
}

Intrinsics KinectCalibration::depth(uint32_t width, uint32_t height) const {
    struct Mode {
        uint32_t width, height;
        Window window;
    };
    constexpr std::array<Mode, 4> kModes{{{640, 576, {1024, 1024, 192, 180}},
                                          {320, 288, {512, 512, 96, 90}},
                                          {512, 512, {512, 512, 0, 0}},
                                          {1024, 1024, {1024, 1024, 0, 0}}}};
    if (depth_.width != kDepthSensor || depth_.height != kDepthSensor) {
        throw Error("a depth sensor of " + sizeText(depth_.width, depth_.height) + " (allowed: 1024x1024)");
    }
    for (const Mode& mode : kModes) {
        if (mode.width == width && mode.height == height) {
            return lensOf(depth_, mode.window, width, height);
        }
    }
    throw Error(sizeText(width, height) +
                ", which no depth mode has (allowed: 640x576, 320x288, 512x512, 1024x1024)");
}

Intrinsics KinectCalibration::colour(uint32_t width, uint32_t height) const {
    Sensor sensor = colour_;
    if (uint64_t{sensor.width} * 9 == uint64_t{sensor.height} * 16) { // early ones: the middle of 4:3
        sensor.parameters[1] = sensor.parameters[1] * 3 / 4 + 1.0 / 8;
        sensor.parameters[3] = sensor.parameters[3] * 3 / 4;
    } else if (uint64_t{sensor.width} * 3 != uint64_t{sensor.height} * 4) {
        throw Error("a colour sensor of " + sizeText(sensor.width, sensor.height) +
                    " (allowed: 4:3 or 16:9)");
    }
    const bool wide = uint64_t{width} * 9 == uint64_t{height} * 16;
    if (!wide && uint64_t{width} * 3 != uint64_t{height} * 4) {
        throw Error(sizeText(width, height) + ", which no colour mode has (allowed: 16:9 or 4:3)");
    }
    const uint32_t binnedHeight = wide ? width * 3 / 4 : height;
    return lensOf(sensor, {width, binnedHeight, 0, (binnedHeight - height) / 2}, width, height);
}

} // namespace fathom
