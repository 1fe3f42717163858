// SPDX-License-Identifier: Apache-2.0
#include "apps/operate/hud.h"

#include "engine/types/printed.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace fathom::operate {

namespace {

std::string valueText(const WrenchFigures& f) {
    return f.renderedInPart() ? printed("%s %.2f of %.2f %s", f.name, f.delivered, f.whole, f.unit)
                              : printed("%s %.2f %s", f.name, f.delivered, f.unit);
}

// A bar from 0 to the limit: what is delivered, in outline what is not rendered, and marks of limit and peak.
void bar(Console& console, const HudInput& input, const WrenchFigures& f) {
    const float width = ImGui::GetContentRegionAvail().x, height = ImGui::GetTextLineHeight() * 0.72f;
    const auto along = [&](double value) {
        const double share = f.limit > 0.0 ? value / f.limit : 0.0;
        return width * kLimitShare * static_cast<float>(std::clamp(share, 0.0, 1.1));
    };
    fontText(input.fonts.body, colour::kText, valueText(f));
    const std::string right = f.saturated() ? "SATURATED" : printed("limit %.3g %s", f.limit, f.unit);
    ImGui::SameLine(std::max(0.0f, width - ImGui::CalcTextSize(right.c_str()).x));
    fontText(input.fonts.small, f.saturated() ? colour::kWarning : colour::kQuiet, right);
    const ImVec2 at = ImGui::GetCursorScreenPos();
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddRectFilled(at, {at.x + width, at.y + height}, IM_COL32(34, 43, 57, 255), 3.0f);
    list.AddRectFilled(at, {at.x + along(f.delivered), at.y + height}, f.colour, 3.0f);
    if (f.renderedInPart()) {
        list.AddRect(at, {at.x + along(f.whole), at.y + height}, colour::kText, 3.0f);
    }
    const float peak = at.x + along(f.peak), limit = at.x + along(f.limit);
    if (f.peak > 0.0) {
        list.AddLine({peak, at.y}, {peak, at.y + height}, colour::kText, 2.0f);
    }
    list.AddLine({limit, at.y - 2.0f}, {limit, at.y + height + 2.0f}, colour::kWarning, 2.0f);
    ImGui::Dummy({width, height + 2.0f});
    markPlace(console, std::string("bar ") + f.name, at, {width, height});
    explain(console, f.part == &TraceWrench::force ? kForceTip : kTorqueTip);
}

std::string marginText(double margin) {
    return std::isfinite(margin) ? printed("%+.2f N s/m", margin) : std::string("unknown");
}

void passes(Console& console, const HudInput& input) {
    const std::vector<double>& ms = input.run.passMs();
    fontText(input.fonts.body, colour::kText,
             printed("Passes %.2f ms", std::accumulate(ms.begin(), ms.end(), 0.0)));
    ImGui::PushTextWrapPos(0.0f);
    fontText(input.fonts.small, colour::kQuiet, passTimes(input.passNames, ms));
    ImGui::PopTextWrapPos();
    markPlace(console, "passes");
    explain(console, "Time of the passes for the newest frame, from image to regions, and of each pass");
}

} // namespace

std::string passTimes(const std::vector<std::string>& names, const std::vector<double>& ms) {
    const bool slow = std::any_of(ms.begin(), ms.end(), [](double t) { return t >= 1.0; });
    std::string parts;
    for (size_t i = 0; i < ms.size() && i < names.size(); ++i) { // a line never breaks before a number
        parts += (i != 0 ? ", "
                  : slow ? "ms per pass: "
                         : "us per pass: ") +
                 names[i] + "\xc2\xa0" + (slow ? printed("%.2f", ms[i]) : printed("%.0f", 1e3 * ms[i]));
    }
    return parts.empty() ? "none yet" : parts;
}

void drawGauges(Console& console, const HudInput& input) {
    const StepRecord& record = input.run.step().record;
    for (const WrenchFigures& f : figuresOf(input.run, input.haptics)) {
        bar(console, input, f);
    }
    const bool passive = !(record.marginPassive < kMarginNoise);
    fontText(input.fonts.body, passive ? colour::kText : colour::kWarning,
             "Stability margin, passive " + marginText(record.marginPassive) +
                 (passive ? "" : "  NOT PASSIVE"));
    fontText(input.fonts.small, colour::kQuiet,
             "uncoupled " + marginText(record.marginUncoupled) + ", device preset " +
                 input.scene.haptics.device +
                 (input.scene.pilot.empty() ? "" : ", pilot " + input.scene.pilot));
    markPlace(console, "margins");
    explain(console,
            "Damping that the device has beyond what the springs need [N s/m]. Below 0 the springs can "
            "feed energy to the hand: lower haptics.stiffness");
    passes(console, input);
}

} // namespace fathom::operate
