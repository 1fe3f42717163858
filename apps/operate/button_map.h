// SPDX-License-Identifier: Apache-2.0
// Maps the buttons of a haptic device to uses. The pilot assigns a button by pressing it.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>

namespace fathom::operate {

enum class ButtonUse { Guidance, Clutch, Jaws };
constexpr size_t kButtonUses = 3;
const char* buttonUseName(ButtonUse use); // "guidance", "clutch", "jaws"

// Buttons are bits of HandSample::buttons; 0 = none.
using ButtonBits = std::array<uint32_t, kButtonUses>; // by ButtonUse

// The sample's buttons with each pressed button replaced by its use. Never allocates or throws.
uint32_t translated(uint32_t raw, const ButtonBits& native, const ButtonBits& chosen) noexcept;
int buttonNumber(uint32_t bit); // 1 for the lowest bit; 0 = none

class ButtonMap {
public:
    // native: the button that the engine expects for each use; 0 = the scene has none.
    explicit ButtonMap(const ButtonBits& native)
        : native_(native)
        , chosen_(native) {}

    const ButtonBits& native() const { return native_; }
    const ButtonBits& chosen() const { return chosen_; }
    bool has(ButtonUse use) const { return native_[static_cast<size_t>(use)] != 0; }
    // Gives a use this one button. Returns why not, or empty.
    std::string choose(ButtonUse use, uint32_t bit);

    // One JSON object: name of the use and bit of its button. save() throws Error that names the file. load()
    // does nothing without a file; throws BadInput with file, field, value and what is allowed.
    void save(const std::filesystem::path& file) const;
    void load(const std::filesystem::path& file);

private:
    ButtonBits native_, chosen_;
};

// The file of a scene: demo.yaml has demo.buttons.json next to it.
std::filesystem::path buttonFile(const std::filesystem::path& scene);

} // namespace fathom::operate
