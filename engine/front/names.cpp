// SPDX-License-Identifier: Apache-2.0
// Names of the public enumerations, for messages.
#include "engine/front/public.h"

#include <array>
#include <bit>

namespace fathom::v0 {

namespace {

// A value that the enumeration does not have may come from another language.
template <size_t kCount>
const char* nameAt(const std::array<const char*, kCount>& names, size_t index) noexcept {
    return index < kCount ? names[index] : "unknown";
}

} // namespace

const char* name(State state) noexcept {
    constexpr std::array kNames{"Off", "Free", "Contact", "Escape", "Trapped", "Fading", "Waiting"};
    return nameAt(kNames, static_cast<size_t>(state));
}

const char* name(StepWarning warnings) noexcept {
    constexpr std::array kNames{"NoScene", "OldScene",     "ComputeDeviceLost", "NotFinite", "TimeBack",
                                "Stalled", "EngineFailed", "ArmStill",          "OtherClock"};
    const auto bits = static_cast<uint32_t>(warnings);
    return bits == 0 ? "None" : nameAt(kNames, static_cast<size_t>(std::countr_zero(bits)));
}

const char* name(SubmitStatus status) noexcept {
    constexpr std::array kNames{"Accepted",     "MissingStamp", "StampAhead", "StampBack",
                                "MissingImage", "BadPose",      "Closed"};
    return nameAt(kNames, static_cast<size_t>(status));
}

const char* name(ReportStatus status) noexcept {
    constexpr std::array kNames{"Accepted", "MissingStamp", "StampAhead", "StampBack", "BadPosture"};
    return nameAt(kNames, static_cast<size_t>(status));
}

} // namespace fathom::v0
