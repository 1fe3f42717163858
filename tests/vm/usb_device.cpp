// SPDX-License-Identifier: Apache-2.0
#include "tests/vm/usb_device.h"

#include "tests/vm/vhci_port.h"

#include <algorithm>
#include <cerrno>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

namespace fathom::vm {

namespace {

constexpr size_t kHeader = 48;
constexpr uint32_t kSubmit = 1, kUnlink = 2, kReturnSubmit = 3, kReturnUnlink = 4;

uint32_t bigEndian(const uint8_t* p) {
    return uint32_t{p[0]} << 24 | uint32_t{p[1]} << 16 | uint32_t{p[2]} << 8 | p[3];
}

void putBigEndian(Bytes& bytes, uint32_t value) {
    for (int shift = 24; shift >= 0; shift -= 8) {
        bytes.push_back(static_cast<uint8_t>(value >> shift));
    }
}

} // namespace

UsbReply UsbReply::stall() {
    return {.status = -EPIPE};
}

UsbDevice::~UsbDevice() {
    unplug();
}

int UsbDevice::out(uint8_t /*endpoint*/, const Bytes& /*data*/) {
    return 0;
}

void UsbDevice::plug() {
    unplug();
    port_ = freeVhciPort();
    socket_ = attachVhci(port_, static_cast<int>(description_.speed));
    thread_ = std::thread([this] { serve(); });
}

void UsbDevice::unplug() {
    if (!plugged()) {
        return;
    }
    ::shutdown(socket_, SHUT_RDWR);
    thread_.join();
    ::close(socket_.exchange(-1));
    waiting_.clear();
    delayed_.clear();
    waitUntilVhciFree(port_);
}

// Until the kernel closes the other end, or unplug().
void UsbDevice::serve() {
    for (;;) {
        const auto pause = std::clamp<std::chrono::nanoseconds>(
            wakeUp() - Clock::now(), std::chrono::nanoseconds(0), std::chrono::milliseconds(20));
        const timespec timeout{0, static_cast<long>(pause.count())};
        pollfd ready{socket_, POLLIN, 0};
        if (::ppoll(&ready, 1, &timeout, nullptr) > 0 && !receive()) {
            return;
        }
        answerWaiting();
    }
}

Clock::time_point UsbDevice::wakeUp() {
    Clock::time_point at = Clock::now() + std::chrono::milliseconds(20);
    for (const Delayed& one : delayed_) {
        at = std::min(at, one.at);
    }
    const bool someWait = std::any_of(waiting_.begin(), waiting_.end(),
                                      [](const auto& endpoint) { return !endpoint.second.empty(); });
    return someWait ? std::min(at, due()) : at;
}

bool UsbDevice::receive() {
    uint8_t header[kHeader];
    if (!readAll(header, kHeader)) {
        return false;
    }
    switch (bigEndian(header)) {
    case kSubmit:
        return submitted(header);
    case kUnlink:
        return unlink(header);
    default:
        return false;
    }
}

bool UsbDevice::submitted(const uint8_t* header) {
    const uint8_t* s = header + 40;
    Transfer transfer{.number = bigEndian(header + 4),
                      .endpoint = static_cast<uint8_t>(bigEndian(header + 16)),
                      .in = bigEndian(header + 12) == 1,
                      .length = bigEndian(header + 24),
                      .setup = {s[0], s[1], get16(s + 2), get16(s + 4), get16(s + 6)}};
    if (!transfer.in && transfer.length > 0) {
        transfer.out.resize(transfer.length);
        if (!readAll(transfer.out.data(), transfer.out.size())) {
            return false;
        }
    }
    if (transfer.endpoint == 0) {
        return answer(transfer, answerControl(transfer));
    }
    if (!transfer.in) {
        return answer(transfer, {.status = out(transfer.endpoint, transfer.out)});
    }
    waiting_[transfer.endpoint].push_back(std::move(transfer));
    return true;
}

bool UsbDevice::unlink(const uint8_t* header) {
    const bool pending = forget(bigEndian(header + 20));
    Bytes reply;
    for (const uint32_t word : {kReturnUnlink, bigEndian(header + 4), 0u, 0u, 0u,
                                pending ? static_cast<uint32_t>(-ECONNRESET) : 0u}) {
        putBigEndian(reply, word);
    }
    reply.resize(kHeader);
    return writeAll(reply);
}

// Removes the pending transfer with that number; false when there is none.
bool UsbDevice::forget(uint32_t number) {
    const auto late = std::find_if(delayed_.begin(), delayed_.end(),
                                   [number](const Delayed& one) { return one.transfer.number == number; });
    if (late != delayed_.end()) {
        delayed_.erase(late);
        return true;
    }
    for (auto& [endpoint, queue] : waiting_) {
        const auto it = std::find_if(queue.begin(), queue.end(),
                                     [number](const Transfer& t) { return t.number == number; });
        if (it != queue.end()) {
            queue.erase(it);
            return true;
        }
    }
    return false;
}

UsbReply UsbDevice::answerControl(const Transfer& transfer) {
    if ((transfer.setup.requestType & 0x60) == 0) {
        if (std::optional<UsbReply> known = standard(transfer.setup)) {
            return *known;
        }
    }
    return control(transfer.setup, transfer.out);
}

std::optional<UsbReply> UsbDevice::standard(const UsbSetup& setup) {
    switch (setup.request) {
    case 0: // GET_STATUS: self powered
        return UsbReply{.data = {1, 0}};
    case 3: // SET_FEATURE
    case 9: // SET_CONFIGURATION
        return UsbReply{};
    case 6:
        return descriptor(setup);
    case 10: // GET_INTERFACE
        return UsbReply{.data = {0}};
    case 11:
        setInterface(setup.index, setup.value);
        return UsbReply{};
    default: // also CLEAR_FEATURE, because the end of a halt matters to the device
        return std::nullopt;
    }
}

std::optional<UsbReply> UsbDevice::descriptor(const UsbSetup& setup) const {
    const int kind = setup.value >> 8, index = setup.value & 255;
    if ((setup.requestType & 0x1f) != 0) {
        return std::nullopt; // of an interface: handled by the class
    }
    if (kind == 1) {
        return UsbReply{.data = description_.device};
    }
    if (kind == 2) {
        return UsbReply{.data = description_.configuration};
    }
    if (kind == 3 && index == 0) {
        return UsbReply{.data = {4, 3, 9, 4}};
    }
    const auto text = description_.strings.find(index);
    if (kind != 3 || text == description_.strings.end()) {
        return UsbReply::stall();
    }
    Bytes bytes{static_cast<uint8_t>(2 + 2 * text->second.size()), 3};
    for (const char c : text->second) {
        bytes.push_back(static_cast<uint8_t>(c));
        bytes.push_back(0);
    }
    return UsbReply{.data = bytes};
}

void UsbDevice::answerWaiting() {
    const Clock::time_point now = Clock::now();
    for (size_t i = 0; i < delayed_.size();) {
        if (delayed_[i].at <= now) {
            const Delayed one = std::move(delayed_[i]);
            delayed_.erase(delayed_.begin() + static_cast<std::ptrdiff_t>(i));
            send(one.transfer, one.reply);
        } else {
            ++i;
        }
    }
    for (auto& [endpoint, queue] : waiting_) {
        while (!queue.empty()) {
            std::optional<UsbReply> reply = in(endpoint, queue.front().length);
            if (!reply) {
                break;
            }
            answer(queue.front(), std::move(*reply));
            queue.pop_front();
        }
    }
}

bool UsbDevice::answer(const Transfer& transfer, UsbReply reply) {
    if (reply.delay.count() > 0) {
        delayed_.push_back({Clock::now() + reply.delay, transfer, std::move(reply)});
        return true;
    }
    return send(transfer, reply);
}

bool UsbDevice::send(const Transfer& transfer, const UsbReply& reply) {
    const size_t count = transfer.in ? std::min<size_t>(reply.data.size(), transfer.length) : 0;
    const size_t moved = transfer.in ? count : (reply.status == 0 ? transfer.length : 0);
    Bytes message;
    message.reserve(kHeader + count);
    for (const uint32_t word : {kReturnSubmit, transfer.number, 0u, 0u, 0u,
                                static_cast<uint32_t>(reply.status), static_cast<uint32_t>(moved)}) {
        putBigEndian(message, word);
    }
    message.resize(kHeader);
    message.insert(message.end(), reply.data.begin(),
                   reply.data.begin() + static_cast<std::ptrdiff_t>(count));
    return writeAll(message);
}

bool UsbDevice::readAll(void* bytes, size_t count) {
    auto* at = static_cast<uint8_t*>(bytes);
    while (count > 0) {
        const ssize_t n = ::recv(socket_, at, count, 0);
        if (n <= 0) {
            return false;
        }
        at += n;
        count -= static_cast<size_t>(n);
    }
    return true;
}

bool UsbDevice::writeAll(const Bytes& bytes) {
    for (size_t done = 0; done < bytes.size();) {
        const ssize_t n = ::send(socket_, bytes.data() + done, bytes.size() - done, MSG_NOSIGNAL);
        if (n <= 0) {
            return false;
        }
        done += static_cast<size_t>(n);
    }
    return true;
}

} // namespace fathom::vm
