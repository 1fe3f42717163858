// SPDX-License-Identifier: Apache-2.0
#include "devices/usb/usb_ftdi.h"

#include "devices/usb/device_files.h"
#include "devices/usb/udev_rule.h"
#include "engine/types/error.h"

#include <algorithm>
#include <libusb-1.0/libusb.h>

namespace fathom {

namespace {

constexpr uint8_t kOutEndpoint = 0x02, kInEndpoint = 0x81, kVendorOut = 0x40;
constexpr size_t kModemStatus = 2;
constexpr unsigned kControlTimeout = 500; // [ms]
constexpr auto kDrainTime = std::chrono::milliseconds(50);
constexpr auto kCancelTime = std::chrono::milliseconds(1000);

std::string placeOf(libusb_device* device) {
    std::array<uint8_t, 8> ports{};
    const int count = libusb_get_port_numbers(device, ports.data(), static_cast<int>(ports.size()));
    std::string text = "usb ";
    text += std::to_string(libusb_get_bus_number(device));
    for (int i = 0; i < count; ++i) {
        text += i == 0 ? '-' : '.';
        text += std::to_string(ports[static_cast<size_t>(i)]);
    }
    return text;
}

} // namespace

UsbFtdi::UsbFtdi(const std::string& name, uint16_t vendor, uint16_t product) {
    if (libusb_init(&context_) != 0) {
        throw Error("libusb cannot be initialised");
    }
    try {
        open(name, vendor, product);
        in_ = libusb_alloc_transfer(0);
        out_ = libusb_alloc_transfer(0);
        libusb_fill_bulk_transfer(
            in_, handle_, kInEndpoint, inBytes_.data(), static_cast<int>(inBytes_.size()),
            [](libusb_transfer* t) { static_cast<UsbFtdi*>(t->user_data)->onReceived(); }, this, 0);
        payload_.reserve(4096);
        submitReceive();
    } catch (...) {
        close();
        throw;
    }
}

UsbFtdi::~UsbFtdi() {
    close();
}

void UsbFtdi::open(const std::string& name, uint16_t vendor, uint16_t product) {
    libusb_device** list = nullptr;
    const ssize_t count = libusb_get_device_list(context_, &list);
    int error = LIBUSB_ERROR_NO_DEVICE;
    for (ssize_t i = 0; i < count && handle_ == nullptr; ++i) {
        libusb_device_descriptor descriptor{};
        if (libusb_get_device_descriptor(list[i], &descriptor) == 0 && descriptor.idVendor == vendor &&
            descriptor.idProduct == product) {
            place_ = placeOf(list[i]);
            error = libusb_open(list[i], &handle_);
        }
    }
    libusb_free_device_list(list, 1);
    if (error == 0) {
        libusb_set_auto_detach_kernel_driver(handle_, 1);
        error = libusb_claim_interface(handle_, 0);
    }
    if (error == LIBUSB_ERROR_ACCESS) {
        throw BadInput(name, place_, "no permission", kUdevRuleHint);
    }
    if (error == LIBUSB_ERROR_BUSY) {
        throw BadInput(name, place_, "another program uses it", "an unused device");
    }
    if (error != 0) {
        throw BadInput(name, place_.empty() ? "USB device " + usbIdText(vendor, product) : place_,
                       place_.empty() ? "not found" : libusb_error_name(error),
                       "a device that is plugged in");
    }
}

void UsbFtdi::submitReceive() noexcept {
    inPending_ = !gone_ && !closing_ && libusb_submit_transfer(in_) == 0;
    gone_ = gone_ || (!inPending_ && !closing_);
}

void UsbFtdi::onReceived() noexcept {
    inPending_ = false;
    event_ = 1;
    if (in_->status == LIBUSB_TRANSFER_NO_DEVICE) {
        gone_ = true;
    } else if (in_->status == LIBUSB_TRANSFER_COMPLETED) {
        errors_ = 0;
        const auto length = static_cast<size_t>(in_->actual_length);
        for (size_t at = 0; at < length; at += kUsbPacket) {
            const size_t end = std::min(length, at + kUsbPacket);
            for (size_t i = at + kModemStatus; i < end && payload_.size() < payload_.capacity(); ++i) {
                payload_.push_back(inBytes_[i]);
            }
        }
    } else if (++errors_ > kMaxErrors) {
        gone_ = true;
    }
    submitReceive(); // first of all: one transfer is always pending
}

void UsbFtdi::onSent() noexcept {
    outPending_ = false;
    event_ = 1;
    gone_ = gone_ || out_->status == LIBUSB_TRANSFER_NO_DEVICE;
}

void UsbFtdi::checkThere() const {
    if (gone_) {
        throw DeviceLost(place_ + ": unplugged");
    }
}

void UsbFtdi::control(FtdiRequest request, uint16_t value) {
    checkThere();
    const int result = libusb_control_transfer(handle_, kVendorOut, static_cast<uint8_t>(request), value, 0,
                                               nullptr, 0, kControlTimeout);
    if (result < 0) {
        throw DeviceLost(place_ + ": request " + std::to_string(static_cast<int>(request)) +
                         " refused: " + libusb_error_name(result));
    }
}

bool UsbFtdi::send(std::span<const uint8_t> bytes) {
    checkThere();
    if (outPending_) {
        return false;
    }
    const size_t count = std::min(bytes.size(), outBytes_.size());
    std::copy_n(bytes.begin(), count, outBytes_.begin());
    libusb_fill_bulk_transfer(
        out_, handle_, kOutEndpoint, outBytes_.data(), static_cast<int>(count),
        [](libusb_transfer* t) { static_cast<UsbFtdi*>(t->user_data)->onSent(); }, this, 0);
    outPending_ = libusb_submit_transfer(out_) == 0;
    gone_ = gone_ || !outPending_;
    checkThere();
    return true;
}

void UsbFtdi::handleEvents(std::chrono::microseconds most) noexcept {
    timeval time{};
    time.tv_sec = static_cast<time_t>(most.count() / 1000000);
    time.tv_usec = static_cast<suseconds_t>(most.count() % 1000000);
    event_ = 0;
    libusb_handle_events_timeout_completed(context_, &time, &event_);
}

void UsbFtdi::wait(std::chrono::microseconds most) {
    checkThere();
    if (payload_.empty()) {
        handleEvents(most);
    }
    checkThere();
}

void UsbFtdi::take(std::vector<uint8_t>& bytes) {
    bytes.insert(bytes.end(), payload_.begin(), payload_.end());
    payload_.clear();
}

void UsbFtdi::close() noexcept {
    const auto until = [](auto span) { return std::chrono::steady_clock::now() + span; };
    for (const auto end = until(kDrainTime);
         outPending_ && !gone_ && std::chrono::steady_clock::now() < end;) {
        handleEvents(std::chrono::milliseconds(1));
    }
    closing_ = true;
    if (inPending_) {
        libusb_cancel_transfer(in_);
    }
    if (outPending_) {
        libusb_cancel_transfer(out_);
    }
    for (const auto end = until(kCancelTime);
         (inPending_ || outPending_) && std::chrono::steady_clock::now() < end;) {
        handleEvents(std::chrono::milliseconds(5));
    }
    if (inPending_ || outPending_) {
        return; // the kernel still owns the memory: leak it rather than free it
    }
    libusb_free_transfer(in_);
    libusb_free_transfer(out_);
    if (handle_ != nullptr) {
        libusb_release_interface(handle_, 0);
        libusb_close(handle_);
    }
    libusb_exit(context_);
}

} // namespace fathom
