// SPDX-License-Identifier: Apache-2.0
// Targets for data from devices and bridges: descriptors, tables, frames, packets.
#include "devices/bridge/device_socket.h"
#include "devices/bridge/force_gate.h"
#include "devices/bridge/socket_hand.h"
#include "devices/haply/haply_message.h"
#include "devices/haply/web_socket.h"
#include "devices/usb/falcon_kinematics.h"
#include "devices/usb/falcon_packet.h"
#include "devices/usb/space_mouse.h"
#include "devices/v4l2/extension_unit.h"
#include "devices/v4l2/frame_metadata.h"
#include "devices/v4l2/pixel_format.h"
#include "devices/v4l2/realsense_tables.h"
#include "engine/types/error.h"
#include "tests/fuzz/fuzz_target.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <glm/geometric.hpp>

#include <sys/socket.h>

namespace fathom::testing {

namespace {

constexpr UnitGuid kGuid{0x8a, 0x8a, 0x1d, 0xc9, 0x3f, 0x38, 0x44, 0x4f,
                         0x8c, 0x1f, 0x4e, 0x2a, 0x3e, 0x6c, 0x1c, 0x15};

void needLens(const Intrinsics& lens) {
    need(std::isfinite(lens.fx) && std::isfinite(lens.fy) && std::isfinite(lens.cx) &&
         std::isfinite(lens.cy));
}

// Any content as a complete table. The checksum is corrected, so that the code behind it runs.
std::vector<uint8_t> sealed(Bytes input) {
    std::vector<uint8_t> table(input.begin(), input.end());
    if (table.size() > 16) {
        const uint32_t sum = realsense::crc32(Bytes(table).subspan(16));
        std::memcpy(table.data() + 12, &sum, sizeof sum);
    }
    return table;
}

} // namespace

// The first byte selects USB descriptors, a depth table or a colour table.
void readDescriptors(Bytes input) {
    if (input.empty()) {
        return;
    }
    const Bytes rest = input.subspan(1);
    if (input[0] % 4 == 0) {
        const auto unit = unitOf(kGuid, rest);
        need(!unit || rest.size() >= 20);
    } else if (input[0] % 4 == 3) {
        const auto latency = pipeLatencyOf(rest);
        need(!latency || (*latency > 0.0 && *latency < 1.0));
    } else if (input[0] % 4 == 1) {
        needLens(realsense::depthLens(sealed(rest), {640, 480}));
    } else {
        const realsense::ColourTable table = realsense::colourLens(sealed(rest), {1280, 720});
        needLens(table.lens);
        need(isFinite(table.colourTdepth));
    }
}

// Format, size and stride come from the driver; the image has the number of bytes that they require.
void readPixels(Bytes input) {
    if (input.size() < 4) {
        return;
    }
    const auto formats = input[0] % 2 == 0 ? declaredDepthFormats() : colourFormats();
    const uint32_t fourcc = formats[input[1] % formats.size()];
    const VideoSize size{1u + input[2] % 17, 1u + input[3] % 7};
    const Bytes rest = input.subspan(4);
    const size_t whole = imageBytes(fourcc, size, 0);
    std::vector<uint32_t> colour(size_t{size.width} * size.height);
    if (const auto layout = depthLayout(fourcc); layout && input[0] % 2 == 0) {
        std::vector<uint16_t> depth(colour.size());
        if (rest.size() < whole) {
            throw Error("short");
        }
        unpackDepth(*layout, size, 0, std::as_bytes(rest), depth);
    } else {
        std::vector<std::byte> copy(mostColourBytes(colourFormatOf(fourcc), size.width, size.height));
        RawColour raw;
        if (!copyColour(fourcc, size, 0, std::as_bytes(rest), copy, raw).empty()) {
            throw Error("refused");
        }
        need(raw.needed() <= raw.bytes.size());
        unpackColour(raw, colour);
    }
}

void readFalcon(Bytes input) {
    FalconStream stream;
    for (size_t at = 0; at < input.size(); at += 7) { // the stream can be split anywhere
        stream.feed(input.subspan(at, std::min<size_t>(7, input.size() - at)));
    }
    need(stream.packets() * kFalconPacket <= input.size());
    const LegAngles angles = FalconKinematics::anglesOf(stream.newest().encoder);
    if (const auto knob = FalconKinematics::forward(angles)) {
        need(isFinite(*knob) && glm::distance(*knob, FalconKinematics::kHome) < 0.1);
        const auto torques = FalconKinematics::torques(*knob, angles, dvec3(8.0, -8.0, 8.0));
        need(!torques || std::ranges::all_of(*torques, [](double t) { return std::isfinite(t); }));
    }
}

void readSpaceMouse(Bytes input) {
    SpaceMouseState state;
    for (size_t at = 0; at < input.size();) { // a length, then that many bytes of a report
        const size_t size = std::min<size_t>(input[at] % 16, input.size() - at - 1);
        takeSpaceMouseReport(input.subspan(at + 1, size), state);
        const dvec3 axes = spaceMouseAxes(state.shift);
        need(isFinite(axes) && std::abs(axes.x) <= 1.0 && std::abs(axes.y) <= 1.0 && std::abs(axes.z) <= 1.0);
        at += 1 + size;
    }
}

// Packets as received from the socket: one for the engine, or a wrench for the device's side. The first byte
// selects which, and whether the header is corrected.
void readEndpoint(Bytes input) {
    if (input.size() < 2) {
        return;
    }
    int ends[2];
    need(::socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_NONBLOCK, 0, ends) == 0);
    DeviceSocket mine(ends[0]);
    DeviceSocket other(ends[1]);
    std::vector<uint8_t> packet(input.begin() + 1, input.end());
    const bool hand = input[0] % 2 == 0;
    if (input[0] & 2u) {
        packet.resize(hand ? sizeof(fathom_door_hand) : sizeof(fathom_door_wrench));
        const fathom_door_header header =
            socketHeader(hand ? FATHOM_DOOR_HAND : FATHOM_DOOR_WRENCH, packet.size(), 1);
        std::memcpy(packet.data(), &header, sizeof header);
    }
    need(::send(ends[1], packet.data(), packet.size(), MSG_NOSIGNAL) == static_cast<ssize_t>(packet.size()));
    fathom_door_hand sample{};
    fathom_door_wrench wrench{};
    if (hand) {
        Pose pose;
        const bool whole = mine.receive(sample, FATHOM_DOOR_HAND) == SocketEvent::Packet;
        need(!whole || packet.size() == sizeof sample);
        need(!whole || !soundPose(sample, pose) ||
             (isFinite(pose) && std::abs(glm::length(pose.rotation) - 1.0) < 1e-9));
    } else if (mine.receive(wrench, FATHOM_DOOR_WRENCH) == SocketEvent::Packet) {
        ForceGate gate(8.0, 1.0);
        Wrench w;
        std::memcpy(&w.force, wrench.force, sizeof wrench.force);
        std::memcpy(&w.torque, wrench.torque, sizeof wrench.torque);
        gate.accept(w, wrench.header.time_ns);
        const Wrench out = gate.at(wrench.header.time_ns + 1000);
        need(isFinite(out.force) && isFinite(out.torque) && glm::length(out.force) <= 8.0 + 1e-9);
    }
}

// Bytes as received from a WebSocket; the first byte sets how many arrive at a time.
void readHaply(Bytes input) {
    if (input.empty()) {
        return;
    }
    const std::string_view bytes(reinterpret_cast<const char*>(input.data()) + 1, input.size() - 1);
    const size_t step = size_t{input[0]} + 1;
    WebSocketFrames frames;
    std::string text;
    for (size_t at = 0; at < bytes.size(); at += step) {
        frames.add(bytes.substr(at, step));
        auto event = frames.next(text);
        for (; event != WebSocketFrames::Event::None; event = frames.next(text)) {
            need(text.size() <= WebSocketFrames::kMaxBytes);
            if (event == WebSocketFrames::Event::Fault || event == WebSocketFrames::Event::Closed) {
                return;
            }
            const auto state =
                event == WebSocketFrames::Event::Text ? readHaplyState(text, "") : std::nullopt;
            need(!state || (isFinite(state->sample.deviceThandle) && !state->device.empty()));
        }
    }
}

} // namespace fathom::testing
