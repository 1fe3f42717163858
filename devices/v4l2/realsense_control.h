// SPDX-License-Identifier: Apache-2.0
// A RealSense D4xx asked for its calibration over the UVC extension unit of its depth camera: no
// librealsense.
#pragma once

#include "devices/v4l2/extension_unit.h"
#include "devices/v4l2/realsense_tables.h"

#include <optional>
#include <vector>

namespace fathom::realsense {

// The mailbox ("hardware monitor"): 1024 bytes there, 1024 back. Source: librealsense, src/hw-monitor.h.
class Mailbox {
public:
    // Empty when the camera has no such extension unit. The node must outlive it.
    static std::optional<Mailbox> find(const VideoNode& depth);

    // The answer's data. Throws Error when the camera refuses the command or answers another one.
    std::vector<uint8_t> ask(uint32_t command, uint32_t parameter = 0) const;

    // kDepthTable or kColourTable, header included, as realsense_tables.h takes it apart. Throws as ask().
    std::vector<uint8_t> calibrationTable(uint32_t number) const;
    // Metres of one depth unit; 0.001 (said in the log) where the firmware does not tell.
    double depthUnit() const;

private:
    explicit Mailbox(const ExtensionUnit& unit)
        : unit_(unit) {}
    ExtensionUnit unit_;
};

} // namespace fathom::realsense
