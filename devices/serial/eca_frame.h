// SPDX-License-Identifier: Apache-2.0
// Frames of the ECA 5E Micro arm: 51 bytes each way, five joint blocks. Facts from the public driver
// eca_arm5emicro_driver (gitAnto, MIT); other ECA arms and the hardware itself are not verified.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

namespace fathom {

inline constexpr size_t kEcaJoints = 5; // shoulder, slew, elbow, wrist, gripper
// One frame, in either direction.
using EcaBytes = std::array<uint8_t, 51>;

// Command for one joint.
struct EcaDemand {
    enum class Kind : uint8_t { Hold = 0, SpeedCw = 3, SpeedCcw = 4 };
    Kind kind = Kind::Hold;
    uint16_t speed = 0;           // 0..4095
    uint16_t speedLimit = 4095;   // 0..4095
    uint16_t currentLimit = 4095; // 0..4095
};

// Feedback of one joint.
struct EcaStatus {
    uint16_t encoder = 0; // wraps
    uint16_t speed = 0;
    uint8_t current = 0; // [mA] = 0.094 n - 0.2 in the public source; not verified
    uint8_t temperature = 0;
};

// Sum S of bytes 0..48: (S mod 255) - floor(S / 255), as a byte.
uint8_t ecaChecksum(const EcaBytes& frame) noexcept;
EcaBytes encodeEca(const std::array<EcaDemand, kEcaJoints>& demands) noexcept;
EcaBytes encodeEca(const std::array<EcaStatus, kEcaJoints>& status) noexcept; // frame from an arm
std::array<EcaDemand, kEcaJoints> demandsOf(const EcaBytes& frame) noexcept;
std::array<EcaStatus, kEcaJoints> statusOf(const EcaBytes& frame) noexcept;

// Parses bytes into frames: start byte, zeros, end byte and checksum must match; after an invalid frame it
// resynchronises on the next start byte in its buffer. Never allocates or throws.
class EcaReader {
public:
    std::optional<EcaBytes> take(uint8_t byte) noexcept;
    uint64_t damaged() const noexcept { return damaged_; } // invalid frames

private:
    void resync() noexcept;

    EcaBytes frame_{};
    size_t size_ = 0;
    uint64_t damaged_ = 0;
};

} // namespace fathom
