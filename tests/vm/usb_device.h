// SPDX-License-Identifier: Apache-2.0
// A simulated USB device, plugged into the real USB core of the running kernel through vhci_hcd.
// Source: the kernel's Documentation/usb/usbip_protocol.rst (messages) and drivers/usb/usbip/vhci_sysfs.c
// (the files attach and status).
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <thread>
#include <vector>

namespace fathom::vm {

using Bytes = std::vector<uint8_t>;
using Clock = std::chrono::steady_clock;

// The eight bytes of a control request (USB 2.0, 9.3).
struct UsbSetup {
    uint8_t requestType = 0, request = 0;
    uint16_t value = 0, index = 0, length = 0;
};

// The answer to a request or an IN transfer. status 0 or a negative errno: -EPIPE stalls. After `delay`.
struct UsbReply {
    int status = 0;
    Bytes data;
    std::chrono::microseconds delay{0};

    static UsbReply stall();
};

enum class UsbSpeed : uint8_t { Full = 2, High = 3 };

struct UsbDescription {
    Bytes device, configuration; // descriptors, as on the wire
    std::map<int, std::string> strings;
    UsbSpeed speed = UsbSpeed::High;
};

// Derived classes fill `description_` and answer. All callbacks run on the device's one thread, so they need
// no lock. State that a test changes meanwhile is atomic. Control, bulk and interrupt transfers; no
// isochronous ones. A derived class calls unplug() in its destructor, before its own members go.
class UsbDevice {
public:
    virtual ~UsbDevice();
    UsbDevice() = default;
    UsbDevice(const UsbDevice&) = delete;
    UsbDevice& operator=(const UsbDevice&) = delete;

    // Into the first free port of its speed. Needs root and vhci-hcd; throws std::runtime_error with the
    // reason. The kernel enumerates it later. May follow unplug().
    void plug();
    // Like pulling the plug: pending transfers fail. Returns when the port is free again.
    void unplug();
    bool plugged() const { return socket_ >= 0; }

protected:
    // A class, vendor or unknown standard request; `out` is the data of an OUT request.
    virtual UsbReply control(const UsbSetup& setup, const Bytes& out) = 0;
    // A transfer to `endpoint` (number without the direction bit) came; its status.
    virtual int out(uint8_t endpoint, const Bytes& data);
    // A transfer of at most `room` bytes from `endpoint` waits. Returns its reply, or nothing yet (called
    // again at due() and after any arrival).
    virtual std::optional<UsbReply> in(uint8_t endpoint, size_t room) = 0;
    // Time at which in() can change its answer without an arrival.
    virtual Clock::time_point due() { return Clock::now() + std::chrono::milliseconds(1); }
    virtual void setInterface(int /*interface*/, int /*alternate*/) {}
    // True if the host is waiting for data from `endpoint`.
    bool awaits(uint8_t endpoint) const {
        const auto waiting = waiting_.find(endpoint);
        return waiting != waiting_.end() && !waiting->second.empty();
    }

    UsbDescription description_;

private:
    struct Transfer {
        uint32_t number = 0;
        uint8_t endpoint = 0;
        bool in = false;
        uint32_t length = 0;
        UsbSetup setup;
        Bytes out;
    };
    struct Delayed {
        Clock::time_point at;
        Transfer transfer;
        UsbReply reply;
    };

    void serve();
    bool receive();
    bool submitted(const uint8_t* header);
    bool unlink(const uint8_t* header);
    bool forget(uint32_t number);
    UsbReply answerControl(const Transfer& transfer);
    std::optional<UsbReply> standard(const UsbSetup& setup);
    std::optional<UsbReply> descriptor(const UsbSetup& setup) const;
    void answerWaiting();
    Clock::time_point wakeUp();
    bool answer(const Transfer& transfer, UsbReply reply);
    bool send(const Transfer& transfer, const UsbReply& reply);
    bool readAll(void* bytes, size_t count);
    bool writeAll(const Bytes& bytes);

    std::atomic<int> socket_{-1};
    int port_ = -1;
    std::thread thread_;
    std::map<uint8_t, std::deque<Transfer>> waiting_; // IN transfers by endpoint
    std::deque<Delayed> delayed_;
};

// Little-endian building blocks of descriptors.
void put16(Bytes& bytes, uint16_t value);
void put32(Bytes& bytes, uint32_t value);
void putFloat(Bytes& bytes, float value);
void append(Bytes& bytes, const Bytes& more);
uint16_t get16(const uint8_t* bytes);
uint32_t get32(const uint8_t* bytes);

// `deviceClass`: class, subclass and protocol as 0xCCSSPP. Strings 1, 2, 3 are maker, product and serial.
Bytes deviceDescriptor(uint16_t vendor, uint16_t product, uint32_t deviceClass, uint8_t packet0,
                       uint16_t release);
Bytes configurationDescriptor(uint8_t interfaces, const Bytes& body);

} // namespace fathom::vm
