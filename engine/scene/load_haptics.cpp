// SPDX-License-Identifier: Apache-2.0
// Sections `haptics` and `contact` of a scene file.
#include "engine/scene/load.h"

namespace fathom {

namespace {

// A number, or `auto`.
std::optional<double> loadUnless(const YamlNode& node, std::string_view word, const Range& range) {
    if (node.is(word)) {
        return std::nullopt;
    }
    return node.number(range, std::string(word) + " or ");
}

void loadLimits(const YamlNode& limits, Scene::Haptics& haptics) {
    limits.checkKeys({"force", "torque", "slew_N_per_s", "slew_Nm_per_s", "lowpass_hz"});
    if (const auto force = limits.find("force")) {
        haptics.forceLimit = loadUnless(*force, "preset", Range::between(0.0, 1e4));
    }
    if (const auto torque = limits.find("torque")) {
        haptics.torqueLimit = loadUnless(*torque, "preset", Range::between(0.0, 1e3));
    }
    if (const auto slew = limits.find("slew_N_per_s")) {
        haptics.slewForce = slew->number(Range::between(0.1, 1e9));
    }
    if (const auto slew = limits.find("slew_Nm_per_s")) {
        haptics.slewTorque = slew->number(Range::between(1e-3, 1e9));
    }
    if (const auto lowpass = limits.find("lowpass_hz")) {
        haptics.lowpassHz = lowpass->number(Range::zeroOr(0.1, 1e4));
        if (haptics.lowpassHz >= 0.5 * haptics.rateHz) {
            lowpass->refuse("0 (off) or below half of haptics.rate_hz");
        }
    }
}

} // namespace

void loadFeel(const YamlNode& node, Scene::Haptics& haptics) {
    if (const auto stiffness = node.find("stiffness")) {
        haptics.stiffness = loadUnless(*stiffness, "auto", Range::between(1e-3, 1e6));
    }
    if (const auto stiffness = node.find("rotational_stiffness")) {
        haptics.rotationalStiffness = loadUnless(*stiffness, "auto", Range::between(1e-6, 1e5));
    }
    if (const auto friction = node.find("friction")) {
        haptics.friction = friction->number(Range::between(0.0, 1.0));
    }
    if (const auto smooth = node.find("smooth")) {
        haptics.smooth = smooth->boolean();
    }
    if (const auto damping = node.find("damping")) {
        haptics.damping = loadUnless(*damping, "auto", Range::between(0.0, 100.0));
    }
    if (const auto margin = node.find("margin")) {
        haptics.margin = margin->number(Range::between(0.05, 1.0));
    }
    if (const auto limits = node.find("limits")) {
        loadLimits(*limits, haptics);
    }
    if (const auto pull = node.find("guidance_pull")) {
        pull->checkKeys({"force", "torque", "speed"});
        if (const auto force = pull->find("force")) {
            haptics.pullForce = force->number(Range::between(0.0, 100.0));
        }
        if (const auto torque = pull->find("torque")) {
            haptics.pullTorque = torque->number(Range::between(0.0, 10.0));
        }
        if (const auto speed = pull->find("speed")) {
            haptics.pullSpeed = speed->number(Range::between(0.001, 2.0));
        }
    }
}

void loadHaptics(const YamlNode& node, Scene& scene) {
    node.checkKeys({"rate_hz", "device", "stiffness", "rotational_stiffness", "guidance", "step_cap",
                    "solves", "delay", "limits", "guidance_pull", "friction", "damping", "margin", "smooth"});
    Scene::Haptics& haptics = scene.haptics;
    if (const auto rate = node.find("rate_hz")) {
        haptics.rateHz = rate->number(Range::between(100.0, 10000.0));
    }
    if (const auto device = node.find("device")) {
        haptics.device = device->text();
    }
    if (const auto guidance = node.find("guidance")) {
        using Mode = Scene::Haptics::GuidanceMode;
        haptics.guidance = guidance->choice<Mode>({{"target", Mode::Target}, {"paper", Mode::Paper}});
    }
    if (const auto cap = node.find("step_cap")) {
        haptics.stepCap = cap->number(Range::between(1e-5, 0.05));
    }
    if (const auto solves = node.find("solves")) {
        haptics.solves = solves->integer(1, 16);
    }
    if (const auto delay = node.find("delay")) {
        haptics.delay = delay->integer(0, 64);
    }
    loadFeel(node, haptics);
}

void loadContact(const YamlNode& node, Scene& scene) {
    node.checkKeys({"where", "reach", "delay"});
    if (const auto where = node.find("where")) {
        using Where = Scene::Contact::Where;
        scene.contact.where =
            where->choice<Where>({{"auto", Where::Auto}, {"cpu", Where::Cpu}, {"gpu", Where::Gpu}});
    }
    if (const auto reach = node.find("reach")) {
        scene.contact.reach = reach->number(Range::between(1e-4, 1.0));
    }
    if (const auto delay = node.find("delay")) {
        scene.contact.delay = delay->integer(0, 1000);
    }
}

} // namespace fathom
