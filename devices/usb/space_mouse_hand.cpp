// SPDX-License-Identifier: Apache-2.0
#include "devices/usb/space_mouse_hand.h"

#include "devices/usb/device_files.h"
#include "devices/usb/udev_rule.h"
#include "engine/types/error.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

#include <fcntl.h>
#include <unistd.h>

namespace fathom {

namespace {

constexpr int kMaxReports = 64;                         // per tick
constexpr uint32_t kFirstButton = 1, kSecondButton = 2; // of the device

DeviceFile choose(const std::filesystem::path& node) {
    for (const DeviceFile& file : findDeviceFiles()) {
        if (file.kind == DeviceFile::Kind::SpaceMouse && (node.empty() || file.node == node)) {
            return file;
        }
    }
    throw BadInput("spacemouse", node.empty() ? "/dev/hidraw*" : node.string(), "no SpaceMouse",
                   "a device that is plugged in, see `fathom devices`");
}

int openNode(const DeviceFile& file) {
    const int descriptor = ::open(file.node.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    if (descriptor < 0) {
        throw BadInput("spacemouse", file.node.string(),
                       errno == EACCES ? "no permission" : std::strerror(errno), kUdevRuleHint);
    }
    return descriptor;
}

// The same model at any node; -1 = absent, or not yet permitted.
int openAgain(uint16_t vendor, uint16_t product) {
    for (const DeviceFile& file : findDeviceFiles()) {
        if (file.kind == DeviceFile::Kind::SpaceMouse && file.vendor == vendor && file.product == product) {
            const int descriptor = ::open(file.node.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
            if (descriptor >= 0) {
                return descriptor;
            }
        }
    }
    return -1;
}

} // namespace

SpaceMouseHand::SpaceMouseHand(const std::filesystem::path& node, const SpaceMouseOptions& options)
    : SpaceMouseHand(choose(node), options) {}

SpaceMouseHand::SpaceMouseHand(const DeviceFile& file, const SpaceMouseOptions& options)
    : SpaceMouseHand(openNode(file), file.name + " at " + file.node.string(), options,
                     [vendor = file.vendor, product = file.product] { return openAgain(vendor, product); }) {}

SpaceMouseHand::SpaceMouseHand(int descriptor, std::string name, const SpaceMouseOptions& options,
                               std::function<int()> reopen)
    : descriptor_(descriptor)
    , name_(std::move(name))
    , options_(options)
    , reconnector_(std::move(reopen)) {}

SpaceMouseHand::~SpaceMouseHand() {
    if (descriptor_ >= 0) {
        ::close(descriptor_);
    }
}

void SpaceMouseHand::lose() noexcept {
    reconnector_.lose(std::exchange(descriptor_, -1));
    state_ = {};
    ++figures_.losses;
}

void SpaceMouseHand::takeReports(double t) noexcept {
    uint8_t report[64];
    for (int i = 0; i < kMaxReports && descriptor_ >= 0; ++i) {
        const ssize_t got = ::read(descriptor_, report, sizeof report);
        if (got > 0) {
            if (takeSpaceMouseReport({report, static_cast<size_t>(got)}, state_)) {
                heard_ = t;
                ++figures_.samples;
            }
        } else if (got < 0 && (errno == EAGAIN || errno == EINTR)) {
            return;
        } else { // unplugged
            lose();
        }
    }
}

HandSample SpaceMouseHand::read(double t) noexcept {
    if (descriptor_ < 0) {
        descriptor_ = reconnector_.take();
    }
    heard_ = std::min(heard_, t); // another run begins at 0
    takeReports(t);
    if (t - heard_ > kSilence) {
        state_.shift = state_.rotation = {};
    }
    const double step = started_ ? std::clamp(t - before_, 0.0, kMaxStep) : 0.0;
    before_ = t;
    started_ = true;
    pose_.position += step * options_.speed * spaceMouseAxes(state_.shift);
    pose_.rotation = glm::normalize(rotationExp(step * options_.turnSpeed * spaceMouseAxes(state_.rotation)) *
                                    pose_.rotation);
    HandSample sample{pose_, 0};
    if (descriptor_ < 0) {
        sample.buttons = kDeadManOpen | options_.clutchBit;
        return sample;
    }
    sample.buttons |= (state_.buttons & kFirstButton) != 0 ? kGuidanceButton : 0;
    sample.buttons |= (state_.buttons & kSecondButton) != 0 ? kDeadManOpen : 0;
    return sample;
}

} // namespace fathom
