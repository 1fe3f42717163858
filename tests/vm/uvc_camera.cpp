// SPDX-License-Identifier: Apache-2.0
#include "tests/vm/uvc_camera.h"

namespace fathom::vm {

namespace {

constexpr uint8_t kExtensionUnit = 3;
constexpr size_t kMailboxBytes = 1024;

Bytes extensionDescriptor(bool realSense) {
    // {C9606CCB-594C-4D25-AF47-CCC496435995}, the depth unit of a D4xx; else a private GUID.
    const Bytes guid = realSense ? Bytes{0xCB, 0x6C, 0x60, 0xC9, 0x4C, 0x59, 0x25, 0x4D,
                                         0xAF, 0x47, 0xCC, 0xC4, 0x96, 0x43, 0x59, 0x95}
                                 : Bytes{0x11, 0x22, 0x33, 0x44, 0x55, 0x66, 0x77, 0x48,
                                         0x99, 0xAA, 0xBB, 0xCC, 0xDD, 0xEE, 0xFF, 0x01};
    Bytes bytes{26, 0x24, 6, kExtensionUnit};
    append(bytes, guid);
    append(bytes, {1, 1, 1, 1, 0x01, 0}); // controls, pins, source, size of the map, map, name
    return bytes;
}

} // namespace

UvcCamera::UvcCamera(const UvcCameraOptions& options)
    : options_(options)
    , mailbox_(kMailboxBytes, 0) {
    const uint16_t w = options.width, h = options.height;
    const bool inzi = options.depthFormat == UvcFormat::Inzi;
    streams_.emplace_back(UvcStream::Shape{options.depthFormat, w, h, 1, 1, 2, options.realSense},
                          options.paintDepth ? options.paintDepth
                          : inzi             ? plainInzi(w, h)
                                             : plainDepth(w, h));
    if (options.colour) {
        streams_.emplace_back(
            UvcStream::Shape{options.motionJpeg ? UvcFormat::Mjpeg : UvcFormat::Yuyv, w, h, 2, 2, 5, false},
            options.paintColour ? options.paintColour : plainColour(w, h));
    }
    description_.device = deviceDescriptor(options.realSense ? 0x8086 : 0x1209,
                                           options.realSense ? 0x0b03 : 0xd3d3, 0xEF0201, 64, 0x0100);
    description_.strings = {{1, "Fathom"}, {2, "Simulated depth camera"}, {3, options.serial}};
    Bytes body = controlInterface();
    for (const UvcStream& stream : streams_) {
        append(body, stream.descriptors());
    }
    description_.configuration = configurationDescriptor(static_cast<uint8_t>(1 + streams_.size()), body);
}

// Two input terminals (1, 4), the extension unit (3), two output terminals (2, 5).
Bytes UvcCamera::controlInterface() const {
    Bytes units;
    for (const uint8_t terminal : {uint8_t{1}, uint8_t{4}}) {
        append(units, {18, 0x24, 2, terminal, 0x01, 0x02, 0, 0, 0, 0, 0, 0, 0, 0, 3, 0, 0, 0});
    }
    append(units, extensionDescriptor(options_.realSense));
    append(units, {9, 0x24, 3, 2, 0x01, 0x01, 0, kExtensionUnit, 0});
    append(units, {9, 0x24, 3, 5, 0x01, 0x01, 0, 4, 0});
    const auto count = static_cast<uint8_t>(streams_.size());
    Bytes bytes{8, 11, 0, static_cast<uint8_t>(1 + count), 0x0E, 3, 0, 2};
    append(bytes, {9, 4, 0, 0, 0, 0x0E, 1, 0, 2});
    Bytes header{static_cast<uint8_t>(12 + count), 0x24, 1, 0x10, 0x01};
    put16(header, static_cast<uint16_t>(12 + count + units.size()));
    put32(header, 1000000);
    header.push_back(count);
    for (const UvcStream& stream : streams_) {
        header.push_back(stream.shape().interfaceNumber);
    }
    append(bytes, header);
    append(bytes, units);
    return bytes;
}

UsbReply UvcCamera::control(const UsbSetup& setup, const Bytes& out) {
    const int number = setup.index & 255, unit = setup.index >> 8;
    if ((setup.requestType & 0x7f) == 0x21) {
        for (UvcStream& stream : streams_) {
            if (stream.shape().interfaceNumber == number) {
                return stream.control(setup, out);
            }
        }
        return number == 0 && unit == kExtensionUnit ? extension(setup, out) : UsbReply::stall();
    }
    if (setup.requestType == 0x02 && setup.request == 1) { // the halt is cleared: how a bulk stream stops
        for (UvcStream& stream : streams_) {
            if (stream.shape().endpoint == (setup.index & 15)) {
                stream.stop();
            }
        }
        return UsbReply{};
    }
    return UsbReply::stall();
}

UsbReply UvcCamera::extension(const UsbSetup& setup, const Bytes& out) {
    if (setup.value >> 8 != 1) {
        return UsbReply::stall();
    }
    switch (setup.request) {
    case 0x01: // SET_CUR
        if (stallMailbox) {
            return UsbReply::stall();
        }
        mailbox_ = out;
        mailbox_.resize(kMailboxBytes);
        answerMailbox();
        return UsbReply{};
    case 0x81: // GET_CUR
        return {.data = mailbox_, .delay = std::chrono::milliseconds(mailboxDelayMs.load())};
    case 0x82: // GET_MIN
    case 0x83: // GET_MAX
    case 0x84: // GET_RES
    case 0x87: // GET_DEF
        return {.data = Bytes(kMailboxBytes, 0)};
    case 0x85: // GET_LEN
        return {.data = {kMailboxBytes & 255, kMailboxBytes >> 8}};
    case 0x86: // GET_INFO: may be read and written
        return {.data = {3}};
    default:
        return UsbReply::stall();
    }
}

// Request: length, magic, command, four parameters. Answer: the command again or a negative error, data, size
// at 1020.
void UvcCamera::answerMailbox() {
    const uint32_t command = get32(mailbox_.data() + 4), parameter = get32(mailbox_.data() + 8);
    const bool understood = options_.realSense && get16(mailbox_.data() + 2) == 0xCDAB;
    Bytes data;
    if (understood && command == 0x15 && !refuseTables && (parameter != 32 || options_.colourTable)) {
        data = simulated_realsense::table(parameter);
        if (!data.empty() && wrongChecksum) {
            data[12] ^= 1;
        }
    } else if (understood && command == 0x2C && parameter == 9) {
        put32(data, simulated_realsense::kDepthUnitMicros);
        data.resize(20);
    }
    Bytes reply;
    put32(reply, data.empty() ? static_cast<uint32_t>(-1) : command);
    append(reply, data);
    reply.resize(1020);
    put32(reply, static_cast<uint32_t>(data.size()));
    mailbox_ = reply;
}

std::optional<UsbReply> UvcCamera::in(uint8_t endpoint, size_t room) {
    for (UvcStream& stream : streams_) {
        if (stream.shape().endpoint == endpoint) {
            return stream.transfer(room);
        }
    }
    return UsbReply::stall();
}

Clock::time_point UvcCamera::due() {
    Clock::time_point first = Clock::now() + std::chrono::milliseconds(20);
    for (const UvcStream& stream : streams_) {
        first = std::min(first, stream.due());
    }
    return first;
}

} // namespace fathom::vm
