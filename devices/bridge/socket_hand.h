// SPDX-License-Identifier: Apache-2.0
// The engine's end of a hand socket: any device whose bridge listens there.
#pragma once

#include "devices/bridge/device_socket.h"
#include "devices/live_hand.h"
#include "devices/reconnector.h"

#include <atomic>
#include <filesystem>
#include <string>

namespace fathom {

// Reads the pose of a sample; false, with `out` unusable, when it is not finite or its quaternion is zero.
bool soundPose(const fathom_door_hand& packet, Pose& out) noexcept;

// read() and write() belong to the haptic thread: a few system calls each, no wait, no lock, no allocation. A
// Reconnector returns to a lost bridge, ten attempts per second.
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
    void lose() noexcept;
    void reportChange() noexcept; // on the thread of reconnector_

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

    char otherPreset_[sizeof fathom_door_hand::preset]{}; // of a bridge for another device, once `changed_`
    std::atomic<bool> changed_{false};
    bool reported_ = false;   // of the thread of reconnector_
    Reconnector reconnector_; // last: its thread reads the members above
};

} // namespace fathom
