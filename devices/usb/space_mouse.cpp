// SPDX-License-Identifier: Apache-2.0
#include "devices/usb/space_mouse.h"

#include <algorithm>
#include <cmath>

namespace fathom {

namespace {

constexpr uint16_t kLogitech = 0x046d, k3Dconnexion = 0x256f;
constexpr uint16_t kOlder[] = {0xc603, 0xc605, 0xc606, 0xc621, 0xc623, 0xc625,
                               0xc626, 0xc627, 0xc628, 0xc629, 0xc62b, 0xc640};
constexpr uint16_t kNewer[] = {0xc62e, 0xc62f, 0xc631, 0xc632, 0xc633, 0xc635, 0xc636, 0xc638, 0xc63a};
constexpr double kFull = 350.0, kDead = 8.0; // counts

int16_t axisAt(std::span<const uint8_t> bytes, size_t at) {
    return static_cast<int16_t>(bytes[at] | bytes[at + 1] << 8);
}

void takeThree(std::span<const uint8_t> bytes, std::array<int16_t, 3>& out) {
    for (size_t i = 0; i < 3; ++i) {
        out[i] = axisAt(bytes, 2 * i);
    }
}

double share(int16_t raw) {
    const double size = std::abs(static_cast<double>(raw));
    return std::copysign(std::clamp((size - kDead) / (kFull - kDead), 0.0, 1.0), static_cast<double>(raw));
}

} // namespace

bool takeSpaceMouseReport(std::span<const uint8_t> report, SpaceMouseState& state) noexcept {
    if (report.empty()) {
        return false;
    }
    const auto body = report.subspan(1);
    switch (report[0]) {
    case 1:
        if (body.size() < 6) {
            return false;
        }
        takeThree(body, state.shift);
        if (body.size() >= 12) {
            takeThree(body.subspan(6), state.rotation);
        }
        return true;
    case 2:
        if (body.size() < 6) {
            return false;
        }
        takeThree(body, state.rotation);
        return true;
    case 3:
        if (body.empty()) {
            return false;
        }
        state.buttons = 0;
        for (size_t i = 0; i < std::min<size_t>(body.size(), 4); ++i) {
            state.buttons |= static_cast<uint32_t>(body[i]) << (8 * i);
        }
        return true;
    default:
        return false;
    }
}

bool isSpaceMouse(uint16_t vendor, uint16_t product) noexcept {
    const auto in = [product](const auto& list) {
        return std::find(std::begin(list), std::end(list), product) != std::end(list);
    };
    return (vendor == kLogitech && in(kOlder)) || (vendor == k3Dconnexion && in(kNewer));
}

dvec3 spaceMouseAxes(const std::array<int16_t, 3>& raw) noexcept {
    return {share(raw[0]), -share(raw[1]), -share(raw[2])};
}

} // namespace fathom
