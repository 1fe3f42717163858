// SPDX-License-Identifier: Apache-2.0
#include "engine/haptics/device_preset.h"

#include "engine/types/error.h"
#include "engine/types/joined.h"

#include <algorithm>
#include <vector>

namespace fathom {
namespace {

constexpr AxisMask kNone{};
constexpr AxisMask kAll{true, true, true, true, true, true};
constexpr AxisMask kTranslation{true, true, true, false, false, false};
constexpr AxisMask kAllButRoll{true, true, true, true, true, false};

// CHAI3D's table lists what a program may render. Its damping is rendered damping, not the physical b, so b
// stays unknown for all real devices.
const char* const kChai =
    "Force, torque and stiffness limits from the device table of CHAI3D 3.3.0. Physical damping b is "
    "unknown: the preset's stiffness is used as it stands. ";

// Torque limit of devices without torque motors; it limits the residual shown on screen.
constexpr double kShownTorque = 0.2;

DevicePreset chai(const char* name, double force, double stiffness, std::optional<double> torque,
                  AxisMask actuated, AxisMask sensed, const char* more) {
    DevicePreset preset;
    preset.name = name;
    preset.stiffness = stiffness;
    preset.forceLimit = force;
    preset.torqueLimit = torque.value_or(kShownTorque);
    preset.actuated = actuated;
    preset.sensed = sensed;
    preset.source = std::string(kChai) + more;
    return preset;
}

std::vector<DevicePreset> makePresets() {
    const char* const noTorque =
        "It renders no torque; 0.2 N m bounds the residual that is shown (assumption).";
    const char* const noSource =
        "It senses position only; 0.2 N m bounds the residual that is shown (assumption).";
    const char* const torque = "Rotational stiffness is unknown: it follows from the tool's size.";
    std::vector<DevicePreset> presets;
    presets.push_back(
        {"ideal", 1000.0, 0.5, 20.0, 0.01, 20.0, 2.0, kAll, kAll,
         "Not a product: a device whose figures are chosen so that 1000 N/m (20 N m/rad) is exactly the "
         "passive limit 2 b / T at 1 kHz."});
    presets.push_back(
        {"w5d", 1000.0, std::nullopt, std::nullopt, std::nullopt, 8.0, 0.2, kAllButRoll, kAll,
         "Entact W5D, the device of the paper: six axes sensed, roll not actuated. Stiffness 1000 N/m, "
         "8 N and 0.2 N m are assumptions; b is unknown: the preset's stiffness is used as it stands."});
    presets.push_back(chai("falcon", 8.0, 3000.0, std::nullopt, kTranslation, kTranslation, noSource));
    presets.back().source +=
        " Novint Falcon; its library renders up to 20 N s/m, which is no figure of the mechanism.";
    presets.push_back(chai("touch", 3.3, 400.0, std::nullopt, kTranslation, kAll, noTorque));
    presets.push_back(chai("omni", 3.3, 700.0, std::nullopt, kTranslation, kAll, noTorque));
    presets.push_back(chai("desktop", 7.9, 1000.0, std::nullopt, kTranslation, kAll, noTorque));
    presets.push_back(chai("premium15", 8.5, 800.0, 0.188, kAll, kAll, torque));
    presets.push_back(chai("premium30", 22.0, 1000.0, 0.188, kAll, kAll, torque));
    presets.push_back(chai("delta", 20.0, 5000.0, std::nullopt, kTranslation, kTranslation, noSource));
    presets.push_back(chai("omega", 12.0, 5000.0, std::nullopt, kTranslation, kTranslation, noSource));
    presets.push_back(chai("omega6", 12.0, 5000.0, std::nullopt, kTranslation, kAll, noTorque));
    presets.push_back(chai("sigma", 12.0, 4000.0, 0.2, kAll, kAll, torque));
    presets.push_back(chai("lambda", 12.0, 8000.0, 0.2, kAll, kAll, torque));
    presets.push_back({"inverse3", 500.0, std::nullopt, std::nullopt, std::nullopt, 5.0, kShownTorque,
                       kTranslation, kAll,
                       "Haply Inverse3 behind its maker's service, with a VerseGrip that senses orientation. "
                       "500 N/m and 5 N are assumptions, below what such devices render; b is unknown."});
    presets.push_back(
        {"none", 1000.0, std::nullopt, std::nullopt, std::nullopt, 20.0, 2.0, kNone, kAll,
         "A mouse, SpaceMouse or arm without force: everything is residual and is only shown."});
    return presets;
}

// Built at first use, then read only.
const std::vector<DevicePreset>& table() {
    static const std::vector<DevicePreset> kPresets = makePresets();
    return kPresets;
}

} // namespace

std::span<const DevicePreset> devicePresets() {
    return table();
}

const DevicePreset* findPreset(const std::string& name) {
    const auto found = std::ranges::find_if(table(), [&](const DevicePreset& p) { return p.name == name; });
    return found != table().end() ? &*found : nullptr;
}

const DevicePreset& devicePreset(const std::string& name) {
    if (const DevicePreset* preset = findPreset(name)) {
        return *preset;
    }
    throw BadInput("haptics", "device", "'" + name + "'", presetNames());
}

std::string presetNames() {
    return joined(table(), &DevicePreset::name);
}

} // namespace fathom
