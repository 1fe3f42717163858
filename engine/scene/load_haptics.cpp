// SPDX-License-Identifier: Apache-2.0
// Sections `haptics` and `contact` of a scene file.
#include "engine/scene/load.h"

namespace fathom {

namespace {

// A number, or a word that leaves it empty.
void readUnless(const YamlNode& node, std::string_view key, std::string_view word, std::optional<double>& out,
                const Range& range) {
    if (const auto value = node.find(key)) {
        out =
            value->is(word) ? std::nullopt : std::optional(value->number(range, std::string(word) + " or "));
    }
}

void loadLimits(const YamlNode& limits, Scene::Haptics& haptics) {
    limits.checkKeys({"force", "torque", "slew_N_per_s", "slew_Nm_per_s", "lowpass_hz"});
    readUnless(limits, "force", "preset", haptics.forceLimit, Range::between(0.0, 1e4));
    readUnless(limits, "torque", "preset", haptics.torqueLimit, Range::between(0.0, 1e3));
    limits.read("slew_N_per_s", haptics.slewForce, Range::between(0.1, 1e9));
    limits.read("slew_Nm_per_s", haptics.slewTorque, Range::between(1e-3, 1e9));
    if (const auto lowpass = limits.find("lowpass_hz")) {
        haptics.lowpassHz = lowpass->number(Range::zeroOr(0.1, 1e4));
        if (haptics.lowpassHz >= 0.5 * haptics.rateHz) {
            lowpass->refuse("0 (off) or below half of haptics.rate_hz");
        }
    }
}

} // namespace

void loadFeel(const YamlNode& node, Scene::Haptics& haptics) {
    readUnless(node, "stiffness", "auto", haptics.stiffness, Range::between(1e-3, 1e6));
    readUnless(node, "rotational_stiffness", "auto", haptics.rotationalStiffness, Range::between(1e-6, 1e5));
    node.read("friction", haptics.friction, Range::between(0.0, 1.0));
    node.read("smooth", haptics.smooth);
    readUnless(node, "damping", "auto", haptics.damping, Range::between(0.0, 100.0));
    node.read("margin", haptics.margin, Range::between(0.05, 1.0));
    if (const auto limits = node.find("limits")) {
        loadLimits(*limits, haptics);
    }
    if (const auto pull = node.find("guidance_pull")) {
        pull->checkKeys({"force", "torque", "speed"});
        pull->read("force", haptics.pullForce, Range::between(0.0, 100.0));
        pull->read("torque", haptics.pullTorque, Range::between(0.0, 10.0));
        pull->read("speed", haptics.pullSpeed, Range::between(0.001, 2.0));
    }
}

void loadHaptics(const YamlNode& node, Scene& scene) {
    node.checkKeys({"rate_hz", "device", "stiffness", "rotational_stiffness", "guidance", "step_cap",
                    "solves", "delay", "limits", "guidance_pull", "friction", "damping", "margin", "smooth"});
    Scene::Haptics& haptics = scene.haptics;
    node.read("rate_hz", haptics.rateHz, Range::between(100.0, 10000.0));
    node.read("device", haptics.device);
    using Mode = Scene::Haptics::GuidanceMode;
    node.read("guidance", haptics.guidance, {{"target", Mode::Target}, {"paper", Mode::Paper}});
    node.read("step_cap", haptics.stepCap, Range::between(1e-5, 0.05));
    node.read("solves", haptics.solves, 1, 16);
    node.read("delay", haptics.delay, 0, 64);
    loadFeel(node, haptics);
}

void loadContact(const YamlNode& node, Scene& scene) {
    node.checkKeys({"where", "reach", "delay"});
    using Where = Scene::Contact::Where;
    node.read("where", scene.contact.where,
              {{"auto", Where::Auto}, {"cpu", Where::Cpu}, {"gpu", Where::Gpu}});
    node.read("reach", scene.contact.reach, Range::between(1e-4, 1.0));
    node.read("delay", scene.contact.delay, 0, 1000);
}

} // namespace fathom
