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

Fonts loadFonts(double scale) {
    ImGui::GetIO().Fonts->Clear();
    Fonts fonts;
    fonts.body = load("DejaVuSans.ttf", 14.0 * scale);
    fonts.small = load("DejaVuSans.ttf", 11.5 * scale);
    fonts.bold = load("DejaVuSans-Bold.ttf", 14.0 * scale);
    fonts.large = load("DejaVuSans-Bold.ttf", 21.0 * scale);
    return fonts;
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
    const std::pair<ImGuiCol, ImColor> colours[] = {{ImGuiCol_WindowBg, ImColor(17, 22, 30)},
                                                    {ImGuiCol_ChildBg, ImColor(22, 28, 38)},
                                                    {ImGuiCol_Text, ImColor(228, 234, 242)},
                                                    {ImGuiCol_TextDisabled, ImColor(150, 162, 180)},
                                                    {ImGuiCol_FrameBg, ImColor(34, 43, 57)},
                                                    {ImGuiCol_FrameBgHovered, ImColor(46, 58, 77)},
                                                    {ImGuiCol_FrameBgActive, ImColor(56, 72, 96)},
                                                    {ImGuiCol_Button, ImColor(40, 52, 70)},
                                                    {ImGuiCol_ButtonHovered, ImColor(56, 74, 100)},
                                                    {ImGuiCol_ButtonActive, ImColor(70, 94, 128)},
                                                    {ImGuiCol_Header, ImColor(40, 52, 70)},
                                                    {ImGuiCol_HeaderHovered, ImColor(56, 74, 100)},
                                                    {ImGuiCol_Tab, ImColor(28, 36, 48)},
                                                    {ImGuiCol_TabActive, ImColor(52, 70, 96)},
                                                    {ImGuiCol_TabHovered, ImColor(64, 86, 118)},
                                                    {ImGuiCol_CheckMark, ImColor(92, 214, 150)},
                                                    {ImGuiCol_SliderGrab, ImColor(100, 140, 190)},
                                                    {ImGuiCol_Separator, ImColor(44, 55, 72)}};
    for (const auto& [which, colour] : colours) {
        style.Colors[which] = colour;
    }
    style.ScaleAllSizes(static_cast<float>(scale));
    ImGui::GetStyle() = style;
}

} // namespace fathom::operate
