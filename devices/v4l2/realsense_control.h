// SPDX-License-Identifier: Apache-2.0
// Reads the calibration of a RealSense D4xx over the UVC extension unit of its depth camera, without
// librealsense.
#pragma once

#include "devices/v4l2/extension_unit.h"
#include "devices/v4l2/realsense_tables.h"

#include <optional>
#include <vector>

namespace fathom::realsense {

// The mailbox ("hardware monitor"): 1024 bytes each way. Source: librealsense, src/hw-monitor.h.
class Mailbox {
public:
    // Empty when the camera has no such unit. The node must outlive it.
    static std::optional<Mailbox> find(const VideoNode& depth);

    // Data of the answer. Throws Error when the camera rejects the command or answers another one.
    std::vector<uint8_t> ask(uint32_t command, uint32_t parameter = 0) const;

    // kDepthTable or kColourTable, header included, for realsense_tables.h. Throws as ask().
    std::vector<uint8_t> calibrationTable(uint32_t number) const;
    // Metres per depth unit; 0.001, with a log line, when the firmware does not report it.
    double depthUnit() const;

private:
    explicit Mailbox(const ExtensionUnit& unit)
        : unit_(unit) {}
    ExtensionUnit unit_;
};

} // namespace fathom::realsense
