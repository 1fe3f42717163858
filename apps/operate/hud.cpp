// SPDX-License-Identifier: Apache-2.0
#include "apps/operate/hud.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace fathom::operate {

namespace {

constexpr float kBetweenFigures = 22.0f; // [pixels]

template <class... Values>
std::string print(const char* form, Values... values) {
    char text[160];
    std::snprintf(text, sizeof text, form, values...);
    return text;
}

void words(ImFont* font, ImU32 colour, const std::string& text) {
    ImGui::PushFont(font);
    ImGui::PushStyleColor(ImGuiCol_Text, colour);
    ImGui::TextUnformatted(text.c_str());
    ImGui::PopStyleColor();
    ImGui::PopFont();
}

// A value with its name below; nothing where the row has no room for it.
void figure(const HudInput& input, const std::string& value, const char* name, ImU32 colour = colour::kText) {
    const float value0 =
        input.letters.bold->CalcTextSizeA(input.letters.bold->FontSize, 1e9f, 0.0f, value.c_str()).x;
    const float name0 = input.letters.small->CalcTextSizeA(input.letters.small->FontSize, 1e9f, 0.0f, name).x;
    const float end =
        ImGui::GetItemRectMax().x - ImGui::GetWindowPos().x + kBetweenFigures + std::max(value0, name0);
    if (end > ImGui::GetWindowContentRegionMax().x) {
        return;
    }
    ImGui::SameLine(0.0f, kBetweenFigures);
    ImGui::BeginGroup();
    words(input.letters.bold, colour, value);
    words(input.letters.small, colour::kQuiet, name);
    ImGui::EndGroup();
}

std::string valueText(const WrenchFigures& f) {
    return f.renderedInPart() ? print("%s %.2f of %.2f %s", f.name, f.delivered, f.whole, f.unit)
                              : print("%s %.2f %s", f.name, f.delivered, f.unit);
}

// A bar from 0 to the limit: what is delivered, in outline what is not rendered, and marks of limit and peak.
void bar(Console& console, const HudInput& input, const WrenchFigures& f) {
    const float width = ImGui::GetContentRegionAvail().x, height = ImGui::GetTextLineHeight() * 0.72f;
    const auto along = [&](double value) {
        const double share = f.limit > 0.0 ? value / f.limit : 0.0;
        return width * kLimitShare * static_cast<float>(std::clamp(share, 0.0, 1.1));
    };
    words(input.letters.body, colour::kText, valueText(f));
    const std::string right = f.saturated() ? "SATURATED" : print("limit %.3g %s", f.limit, f.unit);
    ImGui::SameLine(std::max(0.0f, width - ImGui::CalcTextSize(right.c_str()).x));
    words(input.letters.small, f.saturated() ? colour::kWarning : colour::kQuiet, right);
    const ImVec2 at = ImGui::GetCursorScreenPos();
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddRectFilled(at, {at.x + width, at.y + height}, IM_COL32(34, 43, 57, 255), 3.0f);
    list.AddRectFilled(at, {at.x + along(f.delivered), at.y + height}, f.colour, 3.0f);
    if (f.renderedInPart()) {
        list.AddRect(at, {at.x + along(f.whole), at.y + height}, colour::kText, 3.0f);
    }
    const float peak = at.x + along(f.peak), limit = at.x + along(f.limit);
    list.AddLine({peak, at.y}, {peak, at.y + height}, colour::kText, 2.0f);
    list.AddLine({limit, at.y - 2.0f}, {limit, at.y + height + 2.0f}, colour::kWarning, 2.0f);
    ImGui::Dummy({width, height + 2.0f});
    markPlace(console, std::string("bar ") + f.name, at, {width, height});
}

// The state of the arm and the largest deviation of a joint from its setpoint.
void armFigure(const HudInput& input) {
    const MeasuredArm& arm = *input.arm;
    const std::string state = armStateName(arm.state);
    const ImU32 colour = isFault(arm.state)            ? colour::kWarning
                         : arm.isOff()                 ? colour::kMeasured
                         : arm.state == ArmState::Held ? colour::kQuiet
                                                       : colour::kText;
    const std::string off = arm.slides ? print("%+.0f mm", arm.error * 1e3)
                                       : print("%+.1f\xc2\xb0", arm.error * 57.29577951308232);
    figure(input, arm.known ? state + " " + off : state,
           arm.known ? ("arm, " + arm.worst + " off").c_str() : "arm, not measured", colour);
}

std::string marginText(double margin) {
    return std::isfinite(margin) ? print("%+.2f N s/m", margin) : std::string("unknown");
}

// Distance from the tool to the nearest region of points, however far it is.
std::string clearanceText(double clearance) {
    return std::isnan(clearance)   ? std::string("unknown")
           : std::isinf(clearance) ? std::string("no region")
           : clearance < 1.0       ? print("%.1f mm", clearance * 1e3)
                                   : print("%.2f m", clearance);
}

void passes(const HudInput& input) {
    double sum = 0.0;
    std::string parts;
    const std::vector<double>& ms = input.run.passMs();
    for (size_t i = 0; i < ms.size() && i < input.passNames.size(); ++i) {
        sum += ms[i];
        parts += (i != 0 ? "  " : "") + input.passNames[i] + print(" %.2f", ms[i]);
    }
    words(input.letters.body, colour::kText, print("GPU passes %.2f ms", sum));
    ImGui::PushTextWrapPos(0.0f);
    words(input.letters.small, colour::kQuiet, parts.empty() ? "none yet" : parts);
    ImGui::PopTextWrapPos();
}

} // namespace

namespace {

// Keeps the end of a long name, which distinguishes it.
std::string shortened(const std::string& text) {
    constexpr size_t kMaxLetters = 38;
    return text.size() <= kMaxLetters ? text : "..." + text.substr(text.size() - kMaxLetters);
}

// The state of the recorder, or the position in a recording.
void recorderFigure(const Console& console, const HudInput& input) {
    if (console.timeLine.on) {
        figure(input,
               (console.timeLine.playing ? "\xe2\x96\xb6 " : "\xe2\x96\xa0 ") +
                   print("%.2f s", console.timeLine.t),
               "recording", colour::kPicked);
    } else {
        figure(input, console.recording ? "\xe2\x97\x8f REC" : "\xe2\x96\xa0 idle", "recorder",
               console.recording ? colour::kWarning : colour::kQuiet);
    }
}

} // namespace

void drawHeadLine(Console& console, const HudInput& input, ImVec2 at, ImVec2 size) {
    ImGui::SetNextWindowPos(at);
    ImGui::SetNextWindowSize(size);
    ImGui::Begin("head", nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings);
    const Mode mode = modeOf({console, input.run, input.haptics});
    ImGui::BeginGroup();
    words(input.letters.large, mode.colour, std::string(mode.sign) + " " + mode.word);
    words(input.letters.small, colour::kQuiet, shortened(input.title));
    ImGui::EndGroup();
    markPlace(console, "head mode");
    ImGui::SameLine(280.0f * console.scale());
    ImGui::Dummy({0.0f, 0.0f});
    const Rates rates = input.run.rates();
    const StepRecord& record = input.run.step().record;
    const double period = input.haptics.period;
    const bool slow = rates.worstPeriodMs > 2.5e3 * period;
    const bool stale = record.sceneAge > input.haptics.staleAfter;
    if (input.handGone) {
        figure(input, "LOST", "haptic device", colour::kWarning);
    }
    if (input.arm != nullptr && input.arm->real) {
        armFigure(input);
        markPlace(console, "head arm");
    }
    if (!input.armHolds.empty()) {
        figure(input, "HELD", "by the arm (W: why)", colour::kCaution);
        markPlace(console, "head arm held");
    }
    figure(input, std::isfinite(record.sceneAge) ? print("%.0f ms", record.sceneAge * 1e3) : "none",
           "scene age", stale ? colour::kWarning : colour::kText);
    figure(input, print("%u", record.contacts), "contacts",
           record.contacts > 0 ? colour::kTouch : colour::kText);
    figure(input, clearanceText(record.clearance), "clearance");
    recorderFigure(console, input);
    figure(input, print("%.0f Hz", rates.hapticHz), "haptic rate");
    if (!console.timeLine.on) { // playback has no camera rate
        figure(input, print("%.1f Hz", rates.cameraHz), "camera rate");
    }
    figure(input, print("%.2f ms", rates.worstPeriodMs), "worst period, 1 s",
           slow ? colour::kCaution : colour::kText);
    figure(input, print("%.0f %%", 100.0 * input.unknownShare), "unobserved");
    figure(input, print("%.0f Hz", input.windowHz), "window");
    if (console.frozen) {
        figure(input, "FROZEN", "fixtures", colour::kCaution);
    }
    ImGui::End();
}

void drawGauges(Console& console, const HudInput& input) {
    const StepRecord& record = input.run.step().record;
    for (const WrenchFigures& f : figuresOf(input.run.trace(), input.run.ripple(), input.haptics)) {
        bar(console, input, f);
    }
    const bool passive = !(record.marginPassive < kMarginNoise);
    words(input.letters.body, passive ? colour::kText : colour::kWarning,
          "Stability margin, passive " + marginText(record.marginPassive) + (passive ? "" : "  NOT PASSIVE"));
    words(input.letters.small, colour::kQuiet,
          "uncoupled " + marginText(record.marginUncoupled) + ", device preset " +
              input.scene.haptics.device + (input.scene.pilot.empty() ? "" : ", pilot " + input.scene.pilot));
    passes(input);
}

} // namespace fathom::operate
