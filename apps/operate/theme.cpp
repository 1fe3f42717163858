// SPDX-License-Identifier: Apache-2.0
#include "apps/operate/theme.h"

#include <filesystem>

namespace fathom::operate {

namespace {

ImFont* load(const char* name, double size) {
    const std::string file = std::string("/usr/share/fonts/truetype/dejavu/") + name;
    ImFontAtlas* atlas = ImGui::GetIO().Fonts;
    static const ImWchar kRanges[] = {0x20,   0xff,   0x2013, 0x2026, 0x2190, 0x2193,
                                      0x25a0, 0x25cf, 0x26a0, 0x26a1, 0};
    ImFontConfig config;
    config.OversampleH = 2;
    if (std::filesystem::exists(file)) {
        return atlas->AddFontFromFileTTF(file.c_str(), static_cast<float>(size), &config, kRanges);
    }
    config.SizePixels = static_cast<float>(size);
    return atlas->AddFontDefault(&config);
}

} // namespace

Letters loadLetters(double scale) {
    ImGui::GetIO().Fonts->Clear();
    Letters letters;
    letters.body = load("DejaVuSans.ttf", 14.0 * scale);
    letters.small = load("DejaVuSans.ttf", 11.5 * scale);
    letters.bold = load("DejaVuSans-Bold.ttf", 14.0 * scale);
    letters.large = load("DejaVuSans-Bold.ttf", 21.0 * scale);
    return letters;
}

void applyTheme(double scale) {
    ImGuiStyle style;
    ImGui::StyleColorsDark(&style);
    style.WindowRounding = style.ChildRounding = 6.0f;
    style.FrameRounding = style.GrabRounding = 4.0f;
    style.WindowBorderSize = 0.0f;
    style.WindowPadding = {10.0f, 8.0f};
    style.ItemSpacing = {8.0f, 5.0f};
    style.FramePadding = {7.0f, 3.0f};
    const auto set = [&](ImGuiCol which, int r, int g, int b, int a = 255) {
        style.Colors[which] = ImColor(r, g, b, a);
    };
    set(ImGuiCol_WindowBg, 17, 22, 30);
    set(ImGuiCol_ChildBg, 22, 28, 38);
    set(ImGuiCol_Text, 228, 234, 242);
    set(ImGuiCol_TextDisabled, 150, 162, 180);
    set(ImGuiCol_FrameBg, 34, 43, 57);
    set(ImGuiCol_FrameBgHovered, 46, 58, 77);
    set(ImGuiCol_FrameBgActive, 56, 72, 96);
    set(ImGuiCol_Button, 40, 52, 70);
    set(ImGuiCol_ButtonHovered, 56, 74, 100);
    set(ImGuiCol_ButtonActive, 70, 94, 128);
    set(ImGuiCol_Header, 40, 52, 70);
    set(ImGuiCol_HeaderHovered, 56, 74, 100);
    set(ImGuiCol_Tab, 28, 36, 48);
    set(ImGuiCol_TabActive, 52, 70, 96);
    set(ImGuiCol_TabHovered, 64, 86, 118);
    set(ImGuiCol_CheckMark, 92, 214, 150);
    set(ImGuiCol_SliderGrab, 100, 140, 190);
    set(ImGuiCol_Separator, 44, 55, 72);
    style.ScaleAllSizes(static_cast<float>(scale));
    ImGui::GetStyle() = style;
}

} // namespace fathom::operate
