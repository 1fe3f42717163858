// SPDX-License-Identifier: Apache-2.0
#include "devices/v4l2/extension_unit.h"

#include "engine/types/error.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>
#include <linux/usb/video.h>
#include <linux/uvcvideo.h>

namespace fathom {

std::optional<uint8_t> unitOf(const UnitGuid& guid, std::span<const uint8_t> descriptors) {
    constexpr uint8_t kClassInterface = 0x24, kExtensionUnit = 6;
    // Length, type, subtype, unit, GUID...
    for (size_t at = 0; at + 2 <= descriptors.size();) {
        const size_t length = descriptors[at];
        if (length < 2 || at + length > descriptors.size()) {
            return std::nullopt;
        }
        const auto one = descriptors.subspan(at, length);
        if (length >= 20 && one[1] == kClassInterface && one[2] == kExtensionUnit &&
            std::equal(guid.begin(), guid.end(), one.begin() + 4)) {
            return one[3];
        }
        at += length;
    }
    return std::nullopt;
}

std::optional<ExtensionUnit> ExtensionUnit::find(const VideoNode& node, const UnitGuid& guid) {
    if (node.usbFolder().empty()) {
        return std::nullopt;
    }
    std::ifstream file(node.usbFolder() / "descriptors", std::ios::binary);
    const std::vector<char> raw{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
    const auto unit = unitOf(guid, {reinterpret_cast<const uint8_t*>(raw.data()), raw.size()});
    return unit ? std::optional(ExtensionUnit(node, *unit)) : std::nullopt;
}

void ExtensionUnit::query(uint8_t selector, uint8_t request, uint8_t* data, uint16_t size) const {
    uvc_xu_control_query query{};
    query.unit = unit_;
    query.selector = selector;
    query.query = request;
    query.size = size;
    query.data = data;
    if (node_->control(UVCIOC_CTRL_QUERY, &query) != 0) {
        throw Error(node_->file().string() + ": extension unit " + std::to_string(unit_) + ", control " +
                    std::to_string(selector) + ": " + std::strerror(errno));
    }
}

uint16_t ExtensionUnit::length(uint8_t selector) const {
    uint8_t bytes[2]{};
    query(selector, UVC_GET_LEN, bytes, sizeof bytes);
    return static_cast<uint16_t>(bytes[0] | bytes[1] << 8);
}

std::vector<uint8_t> ExtensionUnit::get(uint8_t selector, uint16_t length) const {
    std::vector<uint8_t> value(length);
    query(selector, UVC_GET_CUR, value.data(), length);
    return value;
}

void ExtensionUnit::set(uint8_t selector, std::span<const uint8_t> value) const {
    std::vector<uint8_t> copy(value.begin(), value.end());
    query(selector, UVC_SET_CUR, copy.data(), static_cast<uint16_t>(copy.size()));
}

} // namespace fathom
