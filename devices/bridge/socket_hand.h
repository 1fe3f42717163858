// SPDX-License-Identifier: Apache-2.0
// The engine's end of a hand socket: any device whose bridge listens there.
#pragma once

#include "devices/bridge/device_socket.h"
#include "devices/live_hand.h"
#include "devices/reconnector.h"
#include "engine/types/triple_buffer.h"

#include <filesystem>
#include <string>

namespace fathom {

// Reads the pose of a sample; false, with `out` unusable, when it is not finite or the squared length of its
// quaternion is not between 0.5 and 2.
bool soundPose(const fathom_door_hand& packet, Pose& out) noexcept;

// What a bridge sends and the engine does not use.
struct SocketRefusal {
    enum class Kind : uint8_t { None, Pose, Stamp, Packet, Preset };
    Kind kind = Kind::None;
    uint64_t number = 0;       // 1, 2, 3, ...
    fathom_door_hand packet{}; // of Stamp, only the stamp
    size_t bytes = 0;          // received of that packet
    uint64_t age = 0;          // [ns]
};

// read() and write() belong to the haptic thread: a few system calls each, no wait, no lock, no allocation. A
// Reconnector returns to a lost bridge, ten attempts per second. Its thread logs why samples are refused.
class SocketHand final : public LiveHand {
public:
    // Connects and waits at most `patience` seconds for a first valid packet. clutchBit: of hand.map; 0 =
    // none. Throws BadInput for no listener, no permission, a wrong version or size, or no packet.
    SocketHand(std::filesystem::path path, uint32_t clutchBit, double patience = 2.0);
    ~SocketHand() override;

    HandSample read(double t) noexcept override;
    void write(const Wrench& deviceWrench, double dt) noexcept override;

    std::string description() const override;
    std::string preset() const override { return preset_; }
    bool alive() const noexcept override { return alive_; }
    LiveHandFigures figures() const noexcept override { return figures_; }

private:
    void awaitFirst(double patience);
    void take(const fathom_door_hand& packet) noexcept;
    void drain() noexcept;
    void checkAge(uint64_t now) noexcept;
    void refuse(SocketRefusal::Kind kind, const fathom_door_hand& packet, size_t bytes) noexcept;
    void lose() noexcept;
    void reportRefusal() noexcept; // on the thread of reconnector_

    std::filesystem::path path_;
    uint32_t away_; // buttons while the device is absent
    std::string preset_, name_;
    DeviceSocket bridge_;
    HandSample last_;
    uint64_t lastTime_ = 0; // [ns] stamp of the newest sample
    uint64_t lastSequence_ = 0, sent_ = 0;
    uint32_t status_ = 0;
    bool alive_ = false;
    LiveHandFigures figures_;

    uint32_t oldInRow_ = 0; // ticks whose newest sample was too old when it arrived
    SocketRefusal::Kind refused_ = SocketRefusal::Kind::None; // of the newest samples
    uint64_t refusals_ = 0;
    TripleBuffer<SocketRefusal> refusal_; // to the thread of reconnector_
    uint64_t reported_ = 0;               // of that thread: number of the refusal that was logged
    uint64_t quietUntil_ = 0;             // [ns] of that thread
    Reconnector reconnector_;             // last: its thread reads the members above
};

} // namespace fathom
