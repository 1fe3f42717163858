// SPDX-License-Identifier: Apache-2.0
#include "apps/operate/button_map.h"

#include "engine/types/error.h"
#include "engine/types/haptic_device.h"

#include <bit>
#include <fstream>
#include <nlohmann/json.hpp>

namespace fathom::operate {

const char* buttonUseName(ButtonUse use) {
    constexpr const char* kNames[] = {"guidance", "clutch", "jaws"};
    return kNames[static_cast<size_t>(use)];
}

uint32_t translated(uint32_t raw, const ButtonBits& native, const ButtonBits& chosen) noexcept {
    uint32_t known = 0, uses = 0;
    for (size_t i = 0; i < kButtonUses; ++i) {
        known |= native[i] | chosen[i];
        uses |= (raw & chosen[i]) != 0 ? native[i] : 0;
    }
    return (raw & ~known) | uses;
}

int buttonNumber(uint32_t bit) {
    return bit == 0 ? 0 : std::countr_zero(bit) + 1;
}

std::string ButtonMap::choose(ButtonUse use, uint32_t bit) {
    const auto wanted = static_cast<size_t>(use);
    const std::string button = "button " + std::to_string(buttonNumber(bit));
    if (!has(use)) {
        return std::string("this scene has no ") + buttonUseName(use);
    }
    if (!std::has_single_bit(bit)) {
        return "press one button alone";
    }
    if (bit == kDeadManOpen) {
        return button + " is the dead-man switch, which cannot be given away";
    }
    for (size_t i = 0; i < kButtonUses; ++i) {
        if (i != wanted && native_[i] != 0 && chosen_[i] == bit) {
            return button + " is " + buttonUseName(static_cast<ButtonUse>(i)) +
                   " already: give that another button first";
        }
    }
    chosen_[wanted] = bit;
    return "";
}

void ButtonMap::save(const std::filesystem::path& file) const {
    nlohmann::json all = nlohmann::json::object();
    for (size_t i = 0; i < kButtonUses; ++i) {
        if (native_[i] != 0) {
            all[buttonUseName(static_cast<ButtonUse>(i))] = chosen_[i];
        }
    }
    std::ofstream out(file);
    out << all.dump(2) << "\n" << std::flush;
    if (!out) {
        throw Error(file.string() + ": cannot be written");
    }
}

void ButtonMap::load(const std::filesystem::path& file) {
    constexpr std::streamoff kMax = 4096; // [bytes]
    std::ifstream in(file, std::ios::ate);
    if (!in) {
        return;
    }
    if (in.tellg() > kMax) {
        throw BadInput(file.string(), "size", std::to_string(in.tellg()) + " bytes", "at most 4096 bytes");
    }
    in.seekg(0);
    const auto all = nlohmann::json::parse(in, nullptr, false);
    if (!all.is_object()) {
        throw BadInput(file.string(), "content", "no JSON object", "{\"clutch\": 4, ...}");
    }
    ButtonMap read(native_);
    read.chosen_.fill(0);
    for (size_t i = 0; i < kButtonUses; ++i) {
        const auto use = static_cast<ButtonUse>(i);
        const char* name = buttonUseName(use);
        if (!has(use) || !all.contains(name)) {
            continue;
        }
        const bool number = all[name].is_number_unsigned() && all[name].get<uint64_t>() <= 1u << 31;
        const uint32_t bit = number ? all[name].get<uint32_t>() : 0;
        if (const std::string fault = read.choose(use, bit); !number || !fault.empty()) {
            throw BadInput(file.string(), name, all[name].dump(),
                           "one bit of the buttons (1, 4, 8, ...) that has no other use");
        }
    }
    for (size_t i = 0; i < kButtonUses; ++i) { // a use that the file lacks keeps its button if it is free
        const auto use = static_cast<ButtonUse>(i);
        if (has(use) && read.chosen_[i] == 0) {
            (void)read.choose(use, native_[i]);
        }
    }
    chosen_ = read.chosen_;
}

std::filesystem::path buttonFile(const std::filesystem::path& scene) {
    return scene.parent_path() / (scene.stem().string() + ".buttons.json");
}

} // namespace fathom::operate
