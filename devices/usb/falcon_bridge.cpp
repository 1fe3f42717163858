// SPDX-License-Identifier: Apache-2.0
#include "devices/usb/falcon_bridge.h"

#include "devices/usb/falcon_firmware.h"
#include "engine/types/error.h"
#include "engine/types/log.h"

namespace fathom {

namespace {

constexpr double kNoTorque = 0.0; // the knob only translates

} // namespace

FalconBridge::FalconBridge(const Options& options)
    : DeviceBridge("falcon: ")
    , firmware_(options.firmware.empty() ? std::vector<uint8_t>() : readFalconFirmware(options.firmware))
    , device_(std::make_unique<Device>())
    , place_(device_->port.place()) {
    endpoint_.emplace(SocketServer::Options{options.endpoint, "falcon", "Novint Falcon",
                                            FalconDrive::kForceLimit, kNoTorque});
    device_->link.start(firmware_);
}

FalconBridge::~FalconBridge() {
    close();
}

void FalconBridge::open() {
    auto device = std::make_unique<Device>();
    device->link.start(firmware_);
    place_ = device->port.place();
    device_ = std::move(device);
    loggedHomed_.reset();
    log::warn("falcon: back at {}", place_);
}

void FalconBridge::close() noexcept {
    if (!device_) {
        return;
    }
    device_->link.stop();
    const FalconFigures last = device_->link.figures();
    figures_.sent += last.sent;
    figures_.replies += last.replies;
    figures_.late += last.late;
    figures_.surplus += last.surplus;
    figures_.faults += last.faults;
    device_.reset();
    placed_ = false;
}

void FalconBridge::logHoming(bool homed) {
    if (loggedHomed_ != homed) {
        loggedHomed_ = homed;
        log::warn("falcon: {}", homed ? "homed" : "not homed: pull the knob out and push it in");
    }
}

void FalconBridge::exchange() {
    endpoint_->poll();
    FalconCommand command;
    command.motor = placed_ ? drive_.motors(endpoint_->wrench().force) : command.motor;
    command.red = !placed_;
    command.green = placed_;
    command.blue = placed_ && endpoint_->hasEngine();
    if (device_->link.exchange(command, kWait)) {
        const FalconState& state = device_->link.state();
        placed_ = drive_.place(state, sample_);
        logHoming(state.allHomed());
        endpoint_->send(sample_, FATHOM_DOOR_PRESENT | (placed_ ? FATHOM_DOOR_HOMED : 0));
    }
}

} // namespace fathom
