// SPDX-License-Identifier: Apache-2.0
// A UVC extension unit of a camera, found by GUID and accessed through the kernel (UVCIOC_CTRL_QUERY).
// Sources: UVC 1.5 specification 3.7.2.6 (descriptor), linux/uvcvideo.h.
#pragma once

#include "devices/v4l2/video_node.h"

#include <array>
#include <optional>
#include <span>
#include <vector>

namespace fathom {

// GUID bytes as on the wire.
using UnitGuid = std::array<uint8_t, 16>;

// The unit's number from the device's raw USB descriptors; empty when no unit has that GUID.
std::optional<uint8_t> unitOf(const UnitGuid& guid, std::span<const uint8_t> descriptors);

// The node must outlive it.
class ExtensionUnit {
public:
    // Empty when the camera has no such unit.
    static std::optional<ExtensionUnit> find(const VideoNode& node, const UnitGuid& guid);

    // Length of a control's value [bytes]. Like get() and set(), throws Error with the control and the
    // kernel's error (for example a stalled request).
    uint16_t length(uint8_t selector) const;
    std::vector<uint8_t> get(uint8_t selector, uint16_t length) const;
    void set(uint8_t selector, std::span<const uint8_t> value) const;

private:
    ExtensionUnit(const VideoNode& node, uint8_t unit)
        : node_(&node)
        , unit_(unit) {}
    void query(uint8_t selector, uint8_t request, uint8_t* data, uint16_t size) const;

    const VideoNode* node_;
    uint8_t unit_;
};

} // namespace fathom
