// SPDX-License-Identifier: Apache-2.0
#include "tests/vm/haptic/space_mouse_device.h"

namespace fathom::vm {

namespace {

constexpr auto kPeriod = std::chrono::milliseconds(8);

// HID 1.11: two reports of three signed axes (-350..350), or one of six, and one of two buttons.
Bytes makeReportDescriptor(bool combined) {
    Bytes d{0x05, 0x01, 0x09, 0x08, 0xa1, 0x01}; // generic desktop, multi-axis controller
    const uint8_t axes = combined ? 6 : 3;
    for (uint8_t id = 1; id <= 6 / axes; ++id) {
        append(d, {0xa1, 0x00, 0x85, id, 0x16, 0xa2, 0xfe, 0x26, 0x5e, 0x01, 0x36, 0x88, 0xfa, 0x46, 0x78,
                   0x05});
        for (uint8_t axis = 0; axis < axes; ++axis) { // X Y Z, Rx Ry Rz
            append(d, {0x09, static_cast<uint8_t>(0x30 + (id - 1) * 3 + axis)});
        }
        append(d, {0x75, 16, 0x95, axes, 0x81, 0x02, 0xc0});
    }
    append(d, {0xa1, 0x02, 0x85, 3, 0x05, 0x09, 0x19, 1, 0x29, 2, 0x15, 0, 0x25, 1, 0x35, 0, 0x45, 1});
    append(d, {0x75, 1, 0x95, 2, 0x81, 0x02, 0x95, 14, 0x81, 0x03, 0xc0, 0xc0});
    return d;
}

} // namespace

SpaceMouseDevice::SpaceMouseDevice(bool combined)
    : combined_(combined)
    , reportDescriptor_(makeReportDescriptor(combined)) {
    description_.speed = UsbSpeed::Full;
    description_.device = deviceDescriptor(0x046d, 0xc626, 0, 8, 0x0440);
    description_.strings = {{1, "3Dconnexion"}, {2, "SpaceNavigator"}, {3, "SIM00003"}};
    Bytes body{9, 4, 0, 0, 1, 3, 0, 0, 2};
    append(body, {9, 0x21, 0x10, 0x01, 0, 1, 0x22});
    put16(body, static_cast<uint16_t>(reportDescriptor_.size()));
    const uint8_t packet = combined ? 16 : 8;
    append(body, {7, 5, 0x81, 3, packet, 0, 8});
    description_.configuration = configurationDescriptor(1, body);
}

void SpaceMouseDevice::deflect(const std::array<int16_t, 3>& shift, const std::array<int16_t, 3>& tick) {
    const std::lock_guard lock(mutex_);
    shift_ = shift;
    tick_ = tick;
    zeroReported_ = false;
}

void SpaceMouseDevice::press(uint8_t buttons) {
    const std::lock_guard lock(mutex_);
    queue_.push_back({3, buttons, 0});
}

UsbReply SpaceMouseDevice::control(const UsbSetup& setup, const Bytes& /*out*/) {
    if (setup.requestType == 0x81 && setup.request == 6 && setup.value >> 8 == 0x22) {
        return {.data = reportDescriptor_};
    }
    return setup.requestType == 0x21 ? UsbReply{} : UsbReply::stall(); // set idle and the like
}

Bytes SpaceMouseDevice::motion(uint8_t id, std::span<const int16_t> axes) const {
    Bytes report{id};
    for (const int16_t axis : axes) {
        put16(report, static_cast<uint16_t>(axis));
    }
    if (halves) {
        report.resize(4);
    }
    return report;
}

void SpaceMouseDevice::queueMotion() {
    if (combined_) {
        queue_.push_back(
            motion(1, std::array{shift_[0], shift_[1], shift_[2], tick_[0], tick_[1], tick_[2]}));
    } else {
        queue_.push_back(motion(1, shift_));
        queue_.push_back(motion(2, tick_));
    }
}

std::optional<UsbReply> SpaceMouseDevice::in(uint8_t /*endpoint*/, size_t /*room*/) {
    const std::lock_guard lock(mutex_);
    const auto now = Clock::now();
    if (queue_.empty() && now >= due_ && !zeroReported_ && !silent) {
        due_ = now + kPeriod;
        queueMotion();
        const std::array<int16_t, 3> zero{};
        zeroReported_ = shift_ == zero && tick_ == zero;
    }
    if (queue_.empty()) {
        due_ = std::max(due_, now + std::chrono::milliseconds(1));
        return std::nullopt;
    }
    UsbReply reply{.data = queue_.front()};
    queue_.pop_front();
    return reply;
}

} // namespace fathom::vm
