// SPDX-License-Identifier: Apache-2.0
// Exposure, gain, white balance and laser of a live camera by the kernel's extended controls.
// Source: docs.kernel.org/userspace-api/media/v4l, "Extended Controls API", "Camera Control Reference".
#pragma once

#include "devices/camera_controls.h"
#include "devices/v4l2/video_node.h"

#include <mutex>

namespace fathom {

// Opens the nodes for each call, because the camera may get other ones after replugging.
class V4l2Controls final : public CameraControls {
public:
    struct Node { // a device file and the stream that it delivers
        std::string stream;
        std::filesystem::path file;
    };
    explicit V4l2Controls(std::vector<Node> nodes)
        : nodes_(std::move(nodes)) {}

    void moveTo(std::vector<Node> nodes); // after replugging
    std::vector<CameraControl> read() override;
    std::string set(const CameraControl& control, int64_t value) override;

private:
    std::vector<Node> nodes() const;

    mutable std::mutex mutex_;
    std::vector<Node> nodes_;
};

} // namespace fathom
