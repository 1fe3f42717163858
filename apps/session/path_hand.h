// SPDX-License-Identifier: Apache-2.0
// Hands that follow a prescribed path.
#pragma once

#include "devices/simulated/hand_path.h"
#include "engine/scene/scene.h"

#include <memory>

namespace fathom {

// Repeats a path that ends where it starts; follows any other path once.
class PathHand final : public HapticDevice {
public:
    explicit PathHand(HandPath path);

    HandSample read(double t) noexcept override;
    void write(const Wrench&, double) noexcept override {}

private:
    HandPath path_;
    bool closed_;
};

// A hand on the path. feels: the wrench moves the hand (hand.loop of the scene); otherwise it follows the
// path exactly.
std::unique_ptr<HapticDevice> openPathHand(const HandPath& path, const Scene& scene, bool feels);

} // namespace fathom
