// SPDX-License-Identifier: Apache-2.0
#include "apps/tune/tune_settings.h"

#include "apps/output/plot_axis.h"

#include <array>

namespace fathom::tune {

namespace {

std::string millimetres(double metres) {
    return roundNumber(1e3 * metres) + " mm";
}

template <class Value, size_t N>
std::vector<Setting> vary(const Setting& base, Value Setting::*member, const std::array<Value, N>& values) {
    std::vector<Setting> list;
    for (const Value& value : values) {
        Setting other = base;
        other.*member = value;
        if (!(other == base)) {
            list.push_back(other);
        }
    }
    return list;
}

std::string windowOf(const Setting& setting) {
    const std::string edge = std::to_string(2 * setting.radius + 1);
    return setting.radius == 0 ? "no filter" : "filter " + edge + "x" + edge;
}

} // namespace

bool Setting::sameRegions(const Setting& other) const {
    Setting alike = other;
    alike.friction = friction;
    alike.reach = reach;
    return *this == alike;
}

Setting settingOf(const Scene& scene) {
    return {scene.filter.radius,    scene.filter.sigma,  scene.filter.memory, scene.errorBudget,
            scene.haptics.friction, scene.contact.reach, scene.decimation};
}

Scene sceneWith(Scene scene, const Setting& setting) {
    scene.filter.radius = setting.radius;
    scene.filter.sigma = setting.sigma;
    scene.filter.memory = setting.memory;
    scene.errorBudget = setting.errorBudget;
    scene.haptics.friction = setting.friction;
    scene.contact.reach = setting.reach;
    scene.decimation = setting.decimation;
    return scene;
}

const char* nameOf(Vary vary) {
    switch (vary) {
    case Vary::Window:
        return "filter radius";
    case Vary::Sigma:
        return "filter sigma";
    case Vary::Memory:
        return "memory";
    case Vary::Budget:
        return "error budget";
    case Vary::Friction:
        return "friction";
    case Vary::Reach:
        return "reach";
    case Vary::Size:
        return "image size";
    }
    return "";
}

std::string valueOf(const Setting& setting, Vary vary) {
    switch (vary) {
    case Vary::Window:
        return std::to_string(setting.radius) + (setting.radius == 1 ? " pixel" : " pixels");
    case Vary::Sigma:
        return millimetres(setting.sigma);
    case Vary::Memory:
        return std::to_string(setting.memory) + (setting.memory == 1 ? " frame" : " frames");
    case Vary::Budget:
        return millimetres(setting.errorBudget);
    case Vary::Friction:
        return roundNumber(setting.friction);
    case Vary::Reach:
        return millimetres(setting.reach);
    case Vary::Size:
        return setting.decimation == 1 ? "full" : "1/" + std::to_string(setting.decimation);
    }
    return "";
}

std::vector<Setting> othersOf(const Setting& base, Vary what) {
    switch (what) {
    case Vary::Window:
        return vary(base, &Setting::radius, std::array<uint32_t, 5>{0, 1, 2, 3, 5});
    case Vary::Sigma: // means nothing without a window
        return base.radius == 0
                   ? std::vector<Setting>{}
                   : vary(base, &Setting::sigma, std::array<double, 4>{0.003, 0.005, 0.01, 0.02});
    case Vary::Memory:
        return vary(base, &Setting::memory, std::array<uint32_t, 3>{0, 8, 30});
    case Vary::Budget:
        return vary(base, &Setting::errorBudget, std::array<double, 4>{0.0, 0.0001, 0.0003, 0.001});
    case Vary::Friction:
        return vary(base, &Setting::friction, std::array<double, 4>{0.0, 0.05, 0.1, 0.2});
    case Vary::Reach:
        return vary(base, &Setting::reach, std::array<double, 3>{0.005, 0.01, 0.02});
    case Vary::Size:
        return vary(base, &Setting::decimation, std::array<uint32_t, 3>{1, 2, 4});
    }
    return {};
}

std::string wordsOf(const Setting& s) {
    return windowOf(s) + (s.radius == 0 ? "" : ", sigma " + millimetres(s.sigma)) + ", memory " +
           valueOf(s, Vary::Memory) + ", error budget " + millimetres(s.errorBudget) + ", friction " +
           roundNumber(s.friction) + ", reach " + millimetres(s.reach) +
           (s.decimation == 1 ? "" : ", image size " + valueOf(s, Vary::Size));
}

} // namespace fathom::tune
