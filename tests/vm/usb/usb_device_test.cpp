// SPDX-License-Identifier: Apache-2.0
// The simulated USB device itself, seen through the kernel's own USB core and libusb.
#include "tests/vm/usb_device.h"
#include "tests/vm/vhci_port.h"

#include <array>
#include <doctest/doctest.h>
#include <libusb-1.0/libusb.h>

using namespace fathom::vm;

namespace {

constexpr uint16_t kVendor = 0x1209, kProduct = 0x0001;
constexpr uint8_t kIn = 0x81, kOut = 0x01;

// Echoes its input; vendor request 1 answers 42 after `delay`, 2 stalls.
class EchoDevice final : public UsbDevice {
public:
    EchoDevice() {
        description_.device = deviceDescriptor(kVendor, kProduct, 0, 64, 0x0100);
        description_.strings = {{1, "Fathom"}, {2, "echo"}, {3, "1"}};
        Bytes body{9, 4, 0, 0, 2, 255, 255, 255, 0};
        append(body, {7, 5, kIn, 2, 0, 2, 0});
        append(body, {7, 5, kOut, 2, 0, 2, 0});
        description_.configuration = configurationDescriptor(1, body);
    }
    ~EchoDevice() override { unplug(); }
    std::atomic<int> delayMs{0};

private:
    UsbReply control(const UsbSetup& setup, const Bytes& /*out*/) override {
        if (setup.requestType == 0xC0 && setup.request == 1) {
            return {.data = {42}, .delay = std::chrono::milliseconds(delayMs.load())};
        }
        return UsbReply::stall();
    }
    int out(uint8_t /*endpoint*/, const Bytes& data) override {
        held_.push_back(data);
        return 0;
    }
    std::optional<UsbReply> in(uint8_t /*endpoint*/, size_t /*room*/) override {
        if (held_.empty()) {
            return std::nullopt;
        }
        UsbReply reply{.data = held_.front()};
        held_.pop_front();
        return reply;
    }
    std::deque<Bytes> held_;
};

// The device opened through libusb, its interface claimed.
struct Opened {
    Opened() {
        // Without udev a context is not notified of later devices, so each try uses a new one.
        waitFor([this] {
            libusb_init(&context);
            handle = libusb_open_device_with_vid_pid(context, kVendor, kProduct);
            if (handle == nullptr) {
                libusb_exit(context);
                context = nullptr;
            }
            return handle != nullptr;
        });
        REQUIRE(handle != nullptr);
        REQUIRE(libusb_claim_interface(handle, 0) == 0);
    }
    ~Opened() {
        libusb_close(handle);
        libusb_exit(context);
    }
    int ask(uint8_t request, unsigned timeoutMs) {
        return libusb_control_transfer(handle, 0xC0, request, 0, 0, &answer, 1, timeoutMs);
    }
    int move(uint8_t endpoint, uint8_t* bytes, int count) {
        moved = 0;
        return libusb_bulk_transfer(handle, endpoint, bytes, count, &moved, 1000);
    }
    libusb_context* context = nullptr;
    libusb_device_handle* handle = nullptr;
    uint8_t answer = 0;
    int moved = 0;
};

} // namespace

TEST_CASE("A simulated USB device is enumerated by the kernel and echoes data from libusb") {
    EchoDevice device;
    device.plug();
    Opened opened;
    std::array<uint8_t, 700> sent{}, got{};
    for (size_t count : {1u, 16u, 64u, 512u, 700u}) {
        for (size_t i = 0; i < count; ++i) {
            sent[i] = static_cast<uint8_t>(i * 7 + count);
        }
        CHECK(opened.move(kOut, sent.data(), static_cast<int>(count)) == 0);
        CHECK(opened.move(kIn, got.data(), 1024 > got.size() ? static_cast<int>(got.size()) : 1024) == 0);
        CHECK(opened.moved == static_cast<int>(count));
        CHECK(std::equal(sent.begin(), sent.begin() + static_cast<long>(count), got.begin()));
    }
}

TEST_CASE("A simulated USB device stalls a request, and answers one late") {
    EchoDevice device;
    device.plug();
    Opened opened;
    CHECK(opened.ask(2, 1000) == LIBUSB_ERROR_PIPE);
    CHECK(opened.ask(1, 1000) == 1);
    CHECK(opened.answer == 42);
    device.delayMs = 3000;
    CHECK(opened.ask(1, 100) == LIBUSB_ERROR_TIMEOUT);
    device.delayMs = 0;
    CHECK(opened.ask(1, 1000) == 1); // the late answer was withdrawn
}

TEST_CASE("A simulated USB device that is unplugged is gone for libusb and can be plugged in again") {
    EchoDevice device;
    device.plug();
    {
        Opened opened;
        device.unplug();
        uint8_t byte = 0;
        const int error = opened.move(kOut, &byte, 1);
        CHECK_MESSAGE((error == LIBUSB_ERROR_NO_DEVICE || error == LIBUSB_ERROR_IO),
                      libusb_error_name(error));
    }
    device.plug();
    Opened opened;
    CHECK(opened.ask(1, 1000) == 1);
}
