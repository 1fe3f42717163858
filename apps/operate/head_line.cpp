// SPDX-License-Identifier: Apache-2.0
// The engineer's top line: the state, and figures with their names.
#include "apps/operate/disk_space.h"
#include "apps/operate/hud.h"
#include "engine/types/printed.h"

#include <algorithm>
#include <cmath>

namespace fathom::operate {

namespace {

constexpr float kBetweenFigures = 22.0f; // [pixels]

struct Figure {
    std::string value;
    std::string name;
    const char* tip = "";
    ImU32 colour = colour::kText;
    std::string place = "figure " + name;
};

// A value with its name below; nothing where the row has no room for it.
void figure(Console& console, const Fonts& fonts, const Figure& f) {
    const auto width = [](ImFont* font, const std::string& text) {
        return font->CalcTextSizeA(font->FontSize, 1e9f, 0.0f, text.c_str()).x;
    };
    const float end = ImGui::GetItemRectMax().x - ImGui::GetWindowPos().x + kBetweenFigures +
                      std::max(width(fonts.bold, f.value), width(fonts.small, f.name));
    console.places.erase(f.place);
    if (end > ImGui::GetWindowContentRegionMax().x) {
        return;
    }
    ImGui::SameLine(0.0f, kBetweenFigures);
    ImGui::BeginGroup();
    fontText(fonts.bold, f.colour, f.value);
    fontText(fonts.small, colour::kQuiet, f.name);
    ImGui::EndGroup();
    markPlace(console, f.place);
    explain(console, f.tip);
}

// The state of the arm and the largest deviation of a joint from its setpoint.
Figure armFigure(const ShownArm& arm) {
    const std::string state = armStateName(arm.state);
    const ImU32 colour = isFault(arm.state)            ? colour::kWarning
                         : arm.isOff()                 ? colour::kMeasured
                         : arm.state == ArmState::Held ? colour::kQuiet
                                                       : colour::kText;
    const std::string off = arm.slides ? printed("%+.0f mm", arm.error * 1e3)
                                       : printed("%+.1f\xc2\xb0", arm.error * 57.29577951308232);
    return {
        arm.known ? state + " " + off : state, arm.known ? "arm, " + arm.worst + " off" : "arm, not measured",
        "State of the real arm, and how far the worst joint is from where it should be", colour, "head arm"};
}

// Distance from the tool to the nearest region of points, however far it is.
std::string clearanceText(double clearance) {
    return std::isnan(clearance)   ? std::string("unknown")
           : std::isinf(clearance) ? std::string("no region")
           : clearance < 1.0       ? printed("%.1f mm", clearance * 1e3)
                                   : printed("%.2f m", clearance);
}

// Keeps the end of a long name, which distinguishes it.
std::string endOf(const std::string& text) {
    constexpr size_t kMaxCharacters = 38;
    return text.size() <= kMaxCharacters ? text : "..." + text.substr(text.size() - kMaxCharacters);
}

// The state of the recorder, or the position in a recording.
Figure recorderFigure(const Console& console) {
    if (console.timeLine.on) {
        return {(console.timeLine.playing ? "\xe2\x96\xb6 " : "\xe2\x96\xa0 ") +
                    printed("%.2f s", console.timeLine.t),
                "recording", "The moment of the recording that is shown", colour::kPicked};
    }
    return {console.switches.recording ? "\xe2\x97\x8f " + clockText(console.status.recorded.seconds)
                                       : "\xe2\x96\xa0 idle",
            "recorder", "R: start or stop a recording of images, hand, forces and edits",
            console.switches.recording ? colour::kWarning : colour::kQuiet};
}

// Figures that only some runs have.
void someFigures(Console& console, const HudInput& input) {
    if (input.handGone) {
        figure(console, input.fonts,
               {"LOST", "haptic device", "No force until it is back; check its cable", colour::kWarning});
    }
    if (input.arm != nullptr && input.arm->real) {
        figure(console, input.fonts, armFigure(*input.arm));
    }
    if (!input.armHolds.empty()) {
        figure(console, input.fonts,
               {"LIMITED", "by the arm (W: why)", "The arm keeps the tool from following the hand",
                colour::kCaution, "head arm held"});
    }
}

void rateFigures(Console& console, const HudInput& input) {
    const Rates rates = input.run.rates();
    const bool slow = rates.worstPeriodMs > 2.5e3 * input.haptics.period;
    figure(console, input.fonts,
           {printed("%.0f Hz", rates.hapticHz), "haptic rate", "Ticks per second that made a force"});
    if (!console.timeLine.on) { // playback has no camera rate
        figure(console, input.fonts,
               {printed("%.1f Hz", rates.cameraHz), "camera rate", "Images per second that became regions"});
    }
    figure(console, input.fonts,
           {printed("%.2f ms", rates.worstPeriodMs), "worst period, 1 s",
            "Longest time between two ticks in the last second; amber above 2.5 periods",
            slow ? colour::kCaution : colour::kText});
    figure(console, input.fonts,
           {printed("%.0f %%", 100.0 * input.unknownShare), "unobserved",
            "Share of the image without depth. Nothing is protected there; it is hatched"});
    figure(console, input.fonts,
           {printed("%.0f Hz", input.windowHz), "window", "Frames of this window per second"});
}

} // namespace

void drawHeadLine(Console& console, const HudInput& input, ImVec2 at, ImVec2 size) {
    ImGui::SetNextWindowPos(at);
    ImGui::SetNextWindowSize(size);
    ImGui::Begin("head", nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings);
    const Mode mode = modeOf({console, input.run, input.haptics});
    ImGui::BeginGroup();
    fontText(input.fonts.large, mode.colour, std::string(mode.sign) + " " + mode.word);
    fontText(input.fonts.small, colour::kQuiet, endOf(input.title));
    ImGui::EndGroup();
    markPlace(console, "head mode");
    explain(console, mode.meaning);
    ImGui::SameLine(280.0f * console.scale());
    ImGui::Dummy({0.0f, 0.0f});
    const StepRecord& record = input.run.step().record;
    someFigures(console, input);
    const bool stale = isOld(record.sceneAge);
    figure(console, input.fonts,
           {std::isfinite(record.sceneAge) ? printed("%.0f ms", record.sceneAge * 1e3) : "none", "scene age",
            "Time since the camera took the image whose regions act now; while it is red, forces fade",
            stale ? colour::kWarning : colour::kText});
    figure(console, input.fonts,
           {printed("%u", record.contactCount), "contacts", "Contact points that push the tool now",
            record.contactCount > 0 ? colour::kTouch : colour::kText});
    figure(console, input.fonts,
           {clearanceText(record.clearance), "clearance",
            "Distance from the tool to the nearest region of points"});
    figure(console, input.fonts, recorderFigure(console));
    rateFigures(console, input);
    if (console.switches.frozen) {
        figure(console, input.fonts,
               {"FROZEN", "fixtures", "F: release. New images do not change the fixtures", colour::kCaution});
    }
    ImGui::End();
}

} // namespace fathom::operate
