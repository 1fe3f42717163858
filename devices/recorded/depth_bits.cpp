// SPDX-License-Identifier: Apache-2.0
#include "devices/recorded/depth_bits.h"

#include <algorithm>
#include <bit>
#include <bitset>
#include <cstdint>
#include <string>

namespace fathom {

namespace {

constexpr size_t kSamples = 9; // images of the index

// "0000001-000000033369.png": as SUN3D names its depth images.
bool namedSun3d(const std::string& name) {
    return name.size() == 24 && name.ends_with(".png") && name.find_first_not_of("0123456789") == 7 &&
           name[7] == '-' && name.find_first_not_of("0123456789", 8) == 20;
}

// Values of a few images, with their low three bits and the rest of them. Rotated millimetres are multiples
// of eight below 8.192 m, and have the low bits 1 from there to 16 m. So are millimetres in coarse steps
// that eight divides, and those of the Kinect SDK, whose low bits are 0 or the number of a player, 1 to 6.
class ValueSigns {
public:
    void add(uint16_t value) {
        const unsigned low = value & 7u;
        const int rest = value >> 3;
        ++measured_;
        multiples_ += low == 0 ? 1 : 0;
        ones_ += low == 1 ? 1 : 0;
        justBeyond_ += low == 1 && rest < kJustBeyond ? 1 : 0;
        noPlayer_ += low == 7 ? 1 : 0;
        close_ += low == 0 && rest < kClosest ? 1 : 0;
        far_ += low != 0 || rest > kNear ? 1 : 0;
        seen_.set(value);
    }
    // Whether more images cannot tell anything but plain values.
    bool arePlain() const { return (multiples_ + ones_) * 10 < measured_ * 6; }
    DepthBits bits(bool sun3d) const {
        const bool rotated = multiples_ > 0 && few(measured_ - multiples_ - ones_);
        if (sun3d) {
            return rotated ? DepthBits::Rotated : DepthBits::Plain;
        }
        if (!rotated) {
            return havePlayers() ? DepthBits::Players : DepthBits::Plain;
        }
        if (!few(close_) || isCoarse()) {
            return DepthBits::Plain;
        }
        if (!few(ones_) && justBeyond_ * 10 < ones_) { // a room extends beyond 8.192 m
            return DepthBits::Players;
        }
        return few(far_) ? DepthBits::Either : DepthBits::Rotated;
    }

private:
    static constexpr size_t kFewestValues = 32;
    static constexpr int kClosest = 250, // [mm] nearer than cameras see
        kNear = 1000,                    // [mm] stored as 8 m: up to there both readings are usual
        kJustBeyond = 500;               // [mm] beyond 8.192 m

    // As outliers may be.
    bool few(uint64_t pixels) const { return pixels * 10 <= measured_; }

    // Most pixels and most of the different values are multiples of eight, one in eight of plain ones.
    bool havePlayers() const {
        size_t multiples = 0;
        for (size_t value = 0; value < seen_.size(); value += 8) {
            multiples += seen_[value] ? 1 : 0;
        }
        return multiples >= kFewestValues && multiples * 10 >= seen_.count() * 6 &&
               multiples_ * 10 >= measured_ * 6 && noPlayer_ == 0;
    }

    // Whether the values are too few, or nearly all of them have a common divisor of over eight: those of a
    // sensor in whole millimetres do not.
    bool isCoarse() const {
        std::bitset<0x4000> rotated; // [mm] that were seen
        for (size_t value = 0; value < seen_.size(); ++value) {
            if (seen_[value] && (value & 7u) <= 1u) {
                rotated.set(std::rotr(static_cast<uint16_t>(value), 3));
            }
        }
        const size_t all = rotated.count();
        bool coarse = all < kFewestValues;
        for (size_t divisor = 2; divisor * kFewestValues < rotated.size() && !coarse; ++divisor) {
            size_t multiples = 0;
            for (size_t at = divisor; at < rotated.size(); at += divisor) {
                multiples += rotated[at] ? 1 : 0;
            }
            coarse = multiples * 10 >= all * 9;
        }
        return coarse;
    }

    uint64_t measured_ = 0, multiples_ = 0, ones_ = 0, justBeyond_ = 0, noPlayer_ = 0, close_ = 0, far_ = 0;
    std::bitset<0x10000> seen_;
};

} // namespace

std::vector<std::filesystem::path> sampledImages(const RecordingLayout& layout) {
    std::vector<std::filesystem::path> images;
    const size_t step = std::max<size_t>(1, layout.index.size() / kSamples);
    for (size_t i = 0; i < layout.index.size(); i += step) {
        images.push_back(layout.index[i].depth);
    }
    return images;
}

DepthBits depthBits(const RecordingLayout& layout, PngSize size, const DepthUnits& units) {
    std::vector<uint16_t> image(size_t{size.width} * size.height);
    ValueSigns signs;
    for (const std::filesystem::path& file : sampledImages(layout)) {
        uint64_t beyond = 0;
        if (signs.arePlain() || !readDepthImage(file, size, units, image, beyond).empty()) {
            continue;
        }
        for (const uint16_t value : image) {
            if (value != 0 && value != layout.invalid && value != UINT16_MAX) { // no values
                signs.add(value);
            }
        }
    }
    return signs.bits(!layout.index.empty() && namedSun3d(layout.index.front().depth.filename().string()));
}

} // namespace fathom
