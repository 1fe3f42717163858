// SPDX-License-Identifier: Apache-2.0
#include "devices/v4l2/live_calibration.h"

#include "devices/recorded/recording_intrinsics.h"
#include "devices/v4l2/realsense_control.h"
#include "engine/types/error.h"
#include "engine/types/log.h"

namespace fathom {

namespace {

constexpr VideoSize kUsual{640, 480};

VideoSize sizeOf(const Intrinsics& lens) {
    return {lens.width, lens.height};
}

void checkSize(const CameraRequest& request, const char* field, const std::optional<VideoSize>& requested,
               const Intrinsics& lens) {
    if (requested && *requested != sizeOf(lens)) {
        throw BadInput(request.text, field, sizeName(*requested),
                       sizeName(sizeOf(lens)) + ", the size that " + request.intrinsics.string() + " is for");
    }
}

LiveCalibration fromFile(const CameraRequest& request, const ChosenNodes& nodes) {
    LiveCalibration calibration{readIntrinsics(request.intrinsics).camera, request.intrinsics.string()};
    CameraInfo& info = calibration.info;
    checkSize(request, "size", request.size, info.depth);
    if (nodes.colour) {
        checkSize(request, "colour_size", request.colourSize, info.colour);
    }
    return calibration;
}

// Keeps the camera's colour only when it has a colour table: a D430 has no colour sensor and offers infrared
// as colour. A request for that colour gets the reason.
void addColour(const realsense::Mailbox& mailbox, const CameraRequest& request, VideoSize size,
               ChosenNodes& nodes, CameraInfo& info) {
    try {
        using realsense::ColourSensor;
        const auto sensor =
            nodes.depth.product() == realsense::kD405 ? ColourSensor::D405 : ColourSensor::Own;
        const auto colour =
            realsense::colourLens(mailbox.calibrationTable(realsense::kColourTable), size, sensor);
        info.colour = colour.lens;
        info.colourTdepth = colour.colourTdepth;
        info.registered = false;
    } catch (const BadInput&) {
        throw;
    } catch (const Error& e) {
        if (request.colour != "auto" || request.colourFormat != 0 || request.colourSize) {
            throw;
        }
        log::warn("{}: colour is not used: no calibration ({}); set intrinsics=FILE", nodes.depth.card(),
                  e.what());
        nodes.colour.reset();
    }
}

std::optional<LiveCalibration> fromRealSense(const CameraRequest& request, ChosenNodes& nodes) {
    const auto mailbox = realsense::Mailbox::find(nodes.depth);
    if (!mailbox) {
        return std::nullopt;
    }
    LiveCalibration calibration;
    calibration.origin = "its own calibration";
    CameraInfo& info = calibration.info;
    const VideoSize size = request.size.value_or(kUsual);
    info.depth = realsense::depthLens(mailbox->calibrationTable(realsense::kDepthTable), size);
    info.metresPerUnit = mailbox->depthUnit();
    if (nodes.colour) {
        addColour(*mailbox, request, request.colourSize.value_or(size), nodes, info);
    }
    return calibration;
}

} // namespace

LiveCalibration calibrationFor(const CameraRequest& request, ChosenNodes& nodes) {
    std::optional<LiveCalibration> calibration;
    std::string why = "missing: this camera does not report its calibration";
    if (!request.intrinsics.empty()) {
        calibration = fromFile(request, nodes);
    } else {
        try {
            calibration = fromRealSense(request, nodes);
        } catch (const BadInput&) {
            throw;
        } catch (const Error& e) {
            why = std::string("not reported by the camera: ") + e.what();
        }
    }
    if (!calibration) {
        throw BadInput(request.text, "intrinsics", why,
                       "intrinsics=FILE, like intrinsics.json of a recording");
    }
    if (!nodes.colour) {
        calibration->info.hasColour = false;
        calibration->info.registered = true;
        calibration->info.colour = calibration->info.depth;
        calibration->info.colourTdepth = Pose{};
    }
    return *calibration;
}

} // namespace fathom
