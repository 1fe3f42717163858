// SPDX-License-Identifier: Apache-2.0
#include "tests/vm/haptic/space_mouse_device.h"

namespace fathom::vm {

namespace {

constexpr auto kPeriod = std::chrono::milliseconds(8);

// HID 1.11: two reports of three signed axes (-350..350) and one of two buttons.
Bytes makeReportDescriptor() {
    Bytes d{0x05, 0x01, 0x09, 0x08, 0xa1, 0x01}; // generic desktop, multi-axis controller
    for (const uint8_t id : {uint8_t{1}, uint8_t{2}}) {
        const auto usage = static_cast<uint8_t>(id == 1 ? 0x30 : 0x33); // X Y Z, Rx Ry Rz
        append(d, {0xa1, 0x00, 0x85, id, 0x16, 0xa2, 0xfe, 0x26, 0x5e, 0x01, 0x36, 0x88, 0xfa, 0x46, 0x78,
                   0x05});
        append(d,
               {0x09, usage, 0x09, static_cast<uint8_t>(usage + 1), 0x09, static_cast<uint8_t>(usage + 2)});
        append(d, {0x75, 16, 0x95, 3, 0x81, 0x02, 0xc0});
    }
    append(d, {0xa1, 0x02, 0x85, 3, 0x05, 0x09, 0x19, 1, 0x29, 2, 0x15, 0, 0x25, 1, 0x35, 0, 0x45, 1});
    append(d, {0x75, 1, 0x95, 2, 0x81, 0x02, 0x95, 14, 0x81, 0x03, 0xc0, 0xc0});
    return d;
}

} // namespace

SpaceMouseDevice::SpaceMouseDevice()
    : reportDescriptor_(makeReportDescriptor()) {
    description_.speed = UsbSpeed::Full;
    description_.device = deviceDescriptor(0x046d, 0xc626, 0, 8, 0x0440);
    description_.strings = {{1, "3Dconnexion"}, {2, "SpaceNavigator"}, {3, "SIM00003"}};
    Bytes body{9, 4, 0, 0, 1, 3, 0, 0, 2};
    append(body, {9, 0x21, 0x10, 0x01, 0, 1, 0x22});
    put16(body, static_cast<uint16_t>(reportDescriptor_.size()));
    append(body, {7, 5, 0x81, 3, 8, 0, 8});
    description_.configuration = configurationDescriptor(1, body);
}

void SpaceMouseDevice::deflect(const std::array<int16_t, 3>& shift, const std::array<int16_t, 3>& turn) {
    const std::lock_guard lock(mutex_);
    shift_ = shift;
    turn_ = turn;
    zeroTold_ = false;
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

Bytes SpaceMouseDevice::motion(uint8_t id, const std::array<int16_t, 3>& axes) const {
    Bytes report{id};
    for (const int16_t axis : axes) {
        put16(report, static_cast<uint16_t>(axis));
    }
    if (halves) {
        report.resize(4);
    }
    return report;
}

std::optional<UsbReply> SpaceMouseDevice::in(uint8_t /*endpoint*/, size_t /*room*/) {
    const std::lock_guard lock(mutex_);
    const auto now = Clock::now();
    if (queue_.empty() && now >= due_ && !zeroTold_ && !silent) {
        due_ = now + kPeriod;
        queue_.push_back(motion(1, shift_));
        queue_.push_back(motion(2, turn_));
        const std::array<int16_t, 3> zero{};
        zeroTold_ = shift_ == zero && turn_ == zero;
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
