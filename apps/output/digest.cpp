// SPDX-License-Identifier: Apache-2.0
#include "apps/output/digest.h"

#include <bit>
#include <cmath>

namespace fathom {

void Digest::add(const void* bytes, size_t count) noexcept {
    constexpr uint64_t kPrimeLow = 0x13b;
    constexpr int kPrimeHighShift = 24; // 2^88 = 2^64 * 2^24
    const auto* byte = static_cast<const unsigned char*>(bytes);
    for (size_t i = 0; i < count; ++i) {
        low_ ^= byte[i];
        // (high, low) * (2^88 + 0x13b) modulo 2^128. The carry out of low * 0x13b comes from the two halves
        // of low.
        const uint64_t carry = ((low_ >> 32) * kPrimeLow + (((low_ & 0xffffffffu) * kPrimeLow) >> 32)) >> 32;
        high_ = high_ * kPrimeLow + carry + (low_ << kPrimeHighShift);
        low_ *= kPrimeLow;
    }
}

void Digest::add(uint64_t value) noexcept {
    unsigned char bytes[8];
    for (unsigned char& byte : bytes) {
        byte = static_cast<unsigned char>(value & 0xffu);
        value >>= 8;
    }
    add(bytes, sizeof bytes);
}

void Digest::add(double value) noexcept {
    add(std::bit_cast<uint64_t>(std::isnan(value) ? kNotKnown : value));
}

void Digest::add(const StepRecord& tick) noexcept {
    add(tick.t);
    for (const Pose* pose : {&tick.device, &tick.tool}) {
        for (double value : {pose->position.x, pose->position.y, pose->position.z, pose->rotation.w,
                             pose->rotation.x, pose->rotation.y, pose->rotation.z}) {
            add(value);
        }
    }
    for (const dvec3* part : {&tick.wrench.force, &tick.wrench.torque}) {
        add(part->x);
        add(part->y);
        add(part->z);
    }
    add(uint64_t{tick.contactCount});
    add(tick.minGap);
    add(uint64_t{static_cast<uint8_t>(tick.state)});
    add(tick.guidance);
    add(static_cast<uint64_t>(tick.frame));
    add(tick.sceneAge);
    add(uint64_t{tick.stalled});
    add(tick.marginPassive);
    add(tick.marginUncoupled);
}

std::string Digest::hex() const {
    constexpr char kDigits[] = "0123456789abcdef";
    std::string text;
    for (uint64_t half : {high_, low_}) {
        for (int shift = 60; shift >= 0; shift -= 4) {
            text += kDigits[(half >> shift) & 0xfu];
        }
    }
    return text;
}

} // namespace fathom
