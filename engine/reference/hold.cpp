// SPDX-License-Identifier: Apache-2.0
#include "engine/reference/hold.h"

#include <cmath>

namespace fathom::reference {

HoldMemory::Verdict HoldMemory::stays(const FrameView& view, const Memory& memory, double captureTime) {
    Verdict verdict;
    if (memory.cls < 0) {
        return verdict;
    }
    const double left = view.scene().holdSeconds - (captureTime - memory.time);
    if (left < -2e-6) {
        return verdict;
    }
    verdict.unsure = std::abs(left) < 2e-6 && left != 0.0; // times are rounded to microseconds
    const dvec3 q = inverse(view.baseTcamera()).apply(memory.at);
    const FixtureClass& f = *pointClasses(view.scene())[static_cast<size_t>(memory.cls)];
    if (q.z <= 0.0 || (view.dark() && f.usesColour())) {
        verdict.stays = true;
        return verdict;
    }
    const NearestPixel at = nearestPixel(view.camera().depth, q, 1e-3);
    const double z = view.z(at.u, at.v); // 0 outside the image
    const double nearer = q.z - 3.0 * view.camera().sigmaAt(q);
    verdict.stays = z == 0.0 || z < nearer;
    verdict.unsure =
        verdict.unsure || at.unsure || (z != 0.0 && std::abs(z - nearer) < 1e-6 * std::max(1.0, q.z));
    return verdict;
}

std::vector<RegionSphere> HoldMemory::step(const FrameView& view, double captureTime, double previousTime,
                                           std::span<const int> classes, const PointImage& points) {
    last_.resize(view.pixels());
    held_.resize(view.pixels());
    unsure_.resize(view.pixels());
    std::vector<RegionSphere> out(view.pixels());
    const std::vector<double> growth = beamGrowth(view, points);
    for (size_t i = 0; i < view.pixels(); ++i) {
        Memory last = last_[i];
        last.time = previousTime;
        const Verdict a = stays(view, last, captureTime), b = stays(view, held_[i], captureTime);
        if (a.unsure || b.unsure) {
            unsure_[i] = 1;
        }
        held_[i] = a.stays ? last : (b.stays ? held_[i] : Memory{});
        if (held_[i].cls >= 0) {
            out[i] = {held_[i].at, regionRadius(view.scene(), held_[i].cls) + held_[i].grown, held_[i].cls};
        }
        last_[i] = classes[i] < 0 ? Memory{} : Memory{points.at[i], classes[i], captureTime, growth[i]};
    }
    return out;
}

} // namespace fathom::reference
