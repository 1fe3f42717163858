// SPDX-License-Identifier: Apache-2.0
// What the camera tests share: a simulated camera plugged in, and the product's camera opened on it.
#pragma once

#include "devices/v4l2/v4l2_camera.h"
#include "engine/types/error.h"
#include "tests/support/refusal.h"
#include "tests/support/scratch_folder.h"
#include "tests/vm/uvc_camera.h"
#include "tests/vm/vhci_port.h"

#include <doctest/doctest.h>
#include <fstream>
#include <memory>
#include <string>

namespace fathom::vm {

// intrinsics.json of a registered camera of that size, removed at the end.
class IntrinsicsFile : public testing::ScratchFile {
public:
    IntrinsicsFile(int width, int height, double scale = 0.001)
        : ScratchFile("intrinsics-" + std::to_string(width) + ".json") {
        std::ofstream(path()) << "{\"width\": " << width << ", \"height\": " << height
                              << ", \"fx\": 300, \"fy\": 300, \"cx\": " << width / 2
                              << ", \"cy\": " << height / 2 << ", \"depth_scale_m_per_unit\": " << scale
                              << "}";
    }
};

// Waits until the kernel offers a node with depth, and colour when wanted.
inline bool waitForCamera(bool colour = true) {
    return waitFor([colour] {
        bool depth = false, image = !colour;
        for (const VideoNode& node : openVideoNodes()) {
            depth = depth || node.offers(fourccOf("Z16 ")) || node.offers(fourccOf("INZI"));
            image = image || node.offers(fourccOf("YUYV")) || node.offers(fourccOf("MJPG"));
        }
        return depth && image;
    });
}

inline bool waitForNoCamera() {
    return waitFor([] { return openVideoNodes().empty(); });
}

inline std::unique_ptr<V4l2Camera> openLive(const std::string& options) {
    return std::make_unique<V4l2Camera>(parseCameraRequest("v4l2:auto" + options));
}

// A simulated camera, plugged in and found by the kernel, and the file of its lens.
struct PluggedCamera {
    explicit PluggedCamera(const UvcCameraOptions& options)
        : device(options)
        , lens(options.width, options.height) {
        device.plug();
        REQUIRE(waitForCamera(options.colour));
    }
    CameraRequest request() const {
        return parseCameraRequest("v4l2:auto,intrinsics=" + lens.path().string());
    }
    std::unique_ptr<V4l2Camera> open() const { return std::make_unique<V4l2Camera>(request()); }

    UvcCamera device;
    IntrinsicsFile lens;
};

// The error message; empty when the camera opens.
inline std::string cameraRefusal(const std::string& text) {
    return testing::refusalOf<std::exception>([&] { V4l2Camera camera(parseCameraRequest(text)); });
}

// Why the camera is lost; empty while it is not.
inline std::string lossOf(V4l2Camera& camera) {
    return testing::refusalOf<DeviceLost>([&] { camera.next(); });
}

// True if the depth equals plainDepth() except for pixel 0.
inline bool isPlainDepth(const Frame& frame, uint32_t width) {
    for (uint32_t i = 1; i < frame->depth.size(); ++i) {
        if (frame->depth[i] != 1000 + i % width + 2 * (i / width)) {
            return false;
        }
    }
    return !frame->depth.empty();
}

} // namespace fathom::vm
