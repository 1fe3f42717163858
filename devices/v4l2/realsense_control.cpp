// SPDX-License-Identifier: Apache-2.0
#include "devices/v4l2/realsense_control.h"

#include "devices/v4l2/little_endian.h"
#include "engine/types/error.h"
#include "engine/types/log.h"

#include <array>

namespace fathom::realsense {

namespace {

constexpr UnitGuid kDepthUnitGuid{0xcb, 0x6c, 0x60, 0xc9, 0x4c, 0x59, 0x25, 0x4d,
                                  0xaf, 0x47, 0xcc, 0xc4, 0x96, 0x43, 0x59, 0x95};
constexpr uint8_t kMailbox = 1; // selector
constexpr size_t kBytes = 1024, kSizeAt = 1020, kMaxData = kSizeAt - 4;
constexpr uint16_t kMagic = 0xcdab;
constexpr uint32_t kGetTable = 0x15, kGetAdvanced = 0x2c, kDepthControl = 9;

void store(std::span<uint8_t> at, uint32_t value) {
    for (size_t i = 0; i < at.size(); ++i) {
        at[i] = static_cast<uint8_t>(value >> (8 * i));
    }
}

} // namespace

std::optional<Mailbox> Mailbox::find(const VideoNode& depth) {
    const auto unit = ExtensionUnit::find(depth, kDepthUnitGuid);
    // Cameras of other vendors use the same GUID with controls of other lengths.
    if (!unit || unit->length(kMailbox) != kBytes) {
        return std::nullopt;
    }
    return Mailbox(*unit);
}

std::vector<uint8_t> Mailbox::ask(uint32_t command, uint32_t parameter) const {
    std::array<uint8_t, kBytes> request{};
    const std::span<uint8_t> bytes(request);
    store(bytes.subspan(0, 2), 20); // bytes after the first four
    store(bytes.subspan(2, 2), kMagic);
    store(bytes.subspan(4, 4), command);
    store(bytes.subspan(8, 4), parameter);
    unit_.set(kMailbox, request);
    const std::vector<uint8_t> reply = unit_.get(kMailbox, kBytes);
    const uint32_t echo = littleEndianWord(reply, 0), size = littleEndianWord(reply, kSizeAt);
    if (echo != command || size > kMaxData) {
        throw Error("RealSense command " + std::to_string(command) + ": " +
                    (static_cast<int32_t>(echo) < 0
                         ? "refused with " + std::to_string(static_cast<int32_t>(echo))
                         : "answer to " + std::to_string(echo) + " of " + std::to_string(size) + " bytes"));
    }
    return {reply.begin() + 4, reply.begin() + 4 + static_cast<std::ptrdiff_t>(size)};
}

std::vector<uint8_t> Mailbox::calibrationTable(uint32_t number) const {
    return ask(kGetTable, number);
}

double Mailbox::depthUnit() const {
    constexpr double kDefault = 0.001;
    try {
        const std::vector<uint8_t> control = ask(kGetAdvanced, kDepthControl);
        const double unit = control.size() >= 4 ? 1e-6 * littleEndianWord(control, 0) : 0.0;
        if (unit > 0.0) {
            return unit;
        }
    } catch (const Error& e) {
        log::info("{}: using {} m as the depth unit", e.what(), kDefault);
    }
    return kDefault;
}

} // namespace fathom::realsense
