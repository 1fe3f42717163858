// SPDX-License-Identifier: Apache-2.0
// calibration.json of an Azure Kinect: normalised lenses of the whole sensors, and the poses between them.
// Source: Azure-Kinect-Sensor-SDK 8bb59caa, src/calibration and src/transformation.
#pragma once

#include "devices/recorded/json_field.h"
#include "engine/types/camera_info.h"

namespace fathom {

class KinectCalibration {
public:
    // file: for messages. Throws BadInput that names it and the field.
    KinectCalibration(const std::vector<uint8_t>& json, const std::string& file);

    // The lens of images of this size. Throws Error when no depth mode or colour resolution has it, or the
    // lens model is not read.
    Intrinsics depth(uint32_t width, uint32_t height) const;
    Intrinsics colour(uint32_t width, uint32_t height) const;
    const Pose& colourTdepth() const { return colourTdepth_; }

private:
    // A lens in shares of the sensor's size, (0, 0) the corner of the first pixel.
    struct Sensor {
        uint32_t width = 0, height = 0;
        std::string model;
        std::vector<double> parameters; // cx cy fx fy k1 to k6, centre of distortion, p2 p1
        Pose pose;                      // of the rig in the camera
    };
    // Part of the binned sensor that images show.
    struct Window {
        uint32_t binnedWidth, binnedHeight, left, top; // [pixels]
    };
    static Sensor sensor(const JsonField& camera);
    static Intrinsics lensOf(const Sensor& sensor, const Window& window, uint32_t width, uint32_t height);

    Sensor depth_, colour_;
    Pose colourTdepth_;
};

} // namespace fathom
