// SPDX-License-Identifier: Apache-2.0
#include "devices/usb/falcon_link.h"

#include "devices/usb/falcon_firmware.h"
#include "engine/types/error.h"

namespace fathom {

namespace {

constexpr auto kFirstAnswer = std::chrono::milliseconds(300);
constexpr auto kLastAnswer = std::chrono::milliseconds(50);

} // namespace

bool FalconLink::answers() {
    setFalconLine(port_);
    stream_.clear();
    awaiting_ = false;
    receivedAt_ = Clock::now();
    const auto until = receivedAt_ + kFirstAnswer;
    while (Clock::now() < until) {
        if (exchange({}, std::chrono::milliseconds(5))) {
            return true;
        }
    }
    return false;
}

void FalconLink::start(std::span<const uint8_t> firmware) {
    if (answers()) {
        return;
    }
    if (firmware.empty()) {
        throw Error("falcon: no answer; after power-on it needs firmware: --firmware FILE");
    }
    loadFalconFirmware(port_, firmware);
    if (!answers()) {
        throw Error("falcon: no answer after loading the firmware; switch it off and on");
    }
}

bool FalconLink::exchange(const FalconCommand& command, std::chrono::microseconds most) {
    if (!awaiting_ && port_.send(encodeFalcon(command))) {
        awaiting_ = true;
        sentAt_ = Clock::now();
        ++figures_.sent;
    }
    port_.wait(most);
    received_.clear();
    port_.take(received_);
    const uint64_t before = stream_.packets();
    stream_.feed(received_);
    const uint64_t fresh = stream_.packets() - before;
    const auto now = Clock::now();
    if (fresh > 0) {
        figures_.surplus += fresh - (awaiting_ ? 1 : 0);
        figures_.replies += fresh;
        awaiting_ = false;
        receivedAt_ = now;
        return true;
    }
    if (awaiting_ && now - sentAt_ > kReplyTime) {
        ++figures_.late;
        awaiting_ = false;
    }
    if (now - receivedAt_ > kLostAfter) {
        throw DeviceLost("falcon: no answer for half a second");
    }
    return false;
}

void FalconLink::stop() noexcept {
    try {
        awaiting_ = false; // zero follows any command in flight
        receivedAt_ = Clock::now();
        const auto until = receivedAt_ + kLastAnswer;
        int answered = 0; // the first answer may belong to an earlier command
        while (answered < 2 && Clock::now() < until) {
            answered += exchange({}, std::chrono::milliseconds(1)) ? 1 : 0;
        }
    } catch (...) { // gone already
    }
}

FalconFigures FalconLink::figures() const noexcept {
    FalconFigures f = figures_;
    f.faults = stream_.faults();
    return f;
}

} // namespace fathom
