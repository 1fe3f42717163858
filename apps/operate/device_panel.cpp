// SPDX-License-Identifier: Apache-2.0
#include "apps/operate/device_panel.h"

#include "engine/types/printed.h"

namespace fathom::operate {

namespace {

std::string heldButtons(uint32_t held) {
    std::string text;
    for (uint32_t bit = 1; bit != 0; bit <<= 1) {
        if ((held & bit) != 0) {
            text += (text.empty() ? "" : ", ") + std::to_string(buttonNumber(bit));
        }
    }
    return text.empty() ? "none" : text;
}

void useRow(Console& console, const ButtonMap& buttons, ButtonUse use) {
    const std::string name = buttonUseName(use);
    if (!buttons.has(use)) {
        ImGui::TextDisabled("%s: this scene has none", name.c_str());
        return;
    }
    const bool waits = console.editing.mapping == use;
    ImGui::TextUnformatted(
        (name + ": button " + std::to_string(buttonNumber(buttons.chosen()[static_cast<size_t>(use)])))
            .c_str());
    ImGui::SameLine(14.0f * ImGui::GetFontSize());
    if (markedButton(console, waits ? ("Cancel##" + name).c_str() : ("Change##" + name).c_str(),
                     "map " + name, "Then press the button of the device that shall do this. Esc cancels")) {
        console.editing.mapping = waits ? std::nullopt : std::optional(use);
    }
}

} // namespace

void drawDevice(Console& console, const HandDeviceFacts& device, const Fonts& fonts) {
    ImGui::PushTextWrapPos(0.0f);
    if (device.description.empty() || device.buttons == nullptr) {
        ImGui::TextDisabled("No haptic device: there are no buttons to map.");
        markPlace(console, "no device");
        explain(console, "Start with --hand-device; 'fathom devices' lists what is connected");
        ImGui::PopTextWrapPos();
        return;
    }
    fontText(fonts.bold, colour::kText, device.description);
    if (!device.present) {
        colouredText(colour::kWarning, "disconnected");
    }
    ImGui::TextUnformatted(("Pressed: " + heldButtons(device.buttonsDown)).c_str());
    markPlace(console, "held buttons");
    explain(console, "Buttons of the device that are down now, numbered from 1. Button 2 is the dead-man "
                     "switch: down while it is open");
    ImGui::PopTextWrapPos();
    ImGui::Separator();
    const float inside = 0.5f * ImGui::GetFontSize(); // the letter j reaches to the left of its place
    ImGui::Indent(inside);
    for (size_t i = 0; i < kButtonUses; ++i) {
        useRow(console, *device.buttons, static_cast<ButtonUse>(i));
    }
    ImGui::Unindent(inside);
    if (console.editing.mapping) {
        colouredText(colour::kPicked, printed("Press the button for %s now. Esc: keep the old one",
                                              buttonUseName(*console.editing.mapping))
                                          .c_str());
    }
}

} // namespace fathom::operate
