// SPDX-License-Identifier: Apache-2.0
#include "apps/operate/mode.h"

#include "apps/operate/arming.h"
#include "apps/operate/theme.h"
#include "apps/operate/wrench_figures.h"
#include "engine/cycle/wrench_stage.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace fathom::operate {

namespace {

constexpr const char* kDot = "\xe2\x97\x8f";
constexpr const char* kSquare = "\xe2\x96\xa0";

Mode forcesOff(const char* meaning) {
    return {"FORCES OFF", kSquare, IM_COL32(255, 255, 255, 255), Edge::Double, meaning};
}

Mode forcesFading(const char* meaning) {
    return {"FORCES FADING", "~", colour::kCaution, Edge::Dashed, meaning};
}

// A chip's word and its meaning. Without a word there is no chip.
struct LossCause {
    const char* word;
    const char* meaning;
};

const char* oldFrameMeaning(const StepRecord& record) {
    return record.sceneAge < 0.0  ? "The newest frame is ahead of the clock: forces fade. Check which clock "
                                    "the camera stamps with"
           : cameraSilent(record) ? "There is no camera image: forces fade until one comes. Check the camera"
                                  : "The newest frame is too old: forces fade until the next one";
}

// Why the device gets no force, or a fading one, although forces are on.
LossCause lossCause(const RunView& run) {
    const StepRecord& record = run.step().record;
    switch (run.fadeReason()) {
    case FadeReason::OldFrame: // the mode says it
        return {cameraSilent(record) && record.sceneAge > 0.0 ? "NO CAMERA IMAGE" : "",
                oldFrameMeaning(record)};
    case FadeReason::SwitchedOff:
        return {"DEAD-MAN OPEN", "No force: the device's dead-man switch is open. Close it"};
    case FadeReason::ArmStill: // the mode says it
        return {"", ""};
    case FadeReason::DeviceLost:
        return {"DEVICE LOST", "No force: the haptic device is lost or silent. Check its cable"};
    case FadeReason::RegionGone:
        return {"REGION GONE", "Forces fade: a region that pressed the hand disappeared"};
    case FadeReason::DeviceWasLost:
        return {"DEVICE LOST", "No force: the haptic device was lost, several times or a moment ago. Wait"};
    case FadeReason::Unknown:
        break;
    }
    return {"", "No force, or a fading one, without a known cause. If it lasts: Space, then A"};
}

bool armHeld(const RunView& run) {
    return run.step().driven && run.step().armStatus.state != ArmState::Follows;
}

// While no fixture pushes.
const char* meaningOfArmed(uint32_t causes) {
    if ((causes & cause::kGuidance) != 0) {
        return "Forces are on; guidance pulls the tool. G ends guidance, Space all forces";
    }
    return causes != 0 ? "Forces are on; no fixture pushes. Space: forces off"
                       : "Forces are on; nothing pushes now. Space: forces off";
}

Mode armedMode(const ModeInput& input) {
    const StepRecord& record = input.run.step().record;
    const StepState state = record.state;
    if (state == StepState::Trapped || armHeld(input.run)) {
        return {"HELD", "!", colour::kWarningWord, Edge::Double,
                "The tool is trapped between regions, or a real arm stands still: forces fade. W says why"};
    }
    if (state == StepState::Off && record.frame >= 0) {
        return forcesOff(lossCause(input.run).meaning);
    }
    if (state == StepState::Fading) {
        const char* meaning = lossCause(input.run).meaning;
        return input.run.fadeReason() == FadeReason::OldFrame
                   ? Mode{"STALE", "~", colour::kCaution, Edge::Dashed, meaning}
                   : forcesFading(meaning);
    }
    if (atForceLimit(record, input.haptics) || atTorqueLimit(record, input.haptics)) {
        return {"AT LIMIT", "!", colour::kWarningWord, Edge::Hatched,
                "Force or torque is at its limit: the hand can press through. Ease off"};
    }
    return state == StepState::Contact || state == StepState::Escape
               ? Mode{"CONTACT", kDot, colour::kTouch, Edge::Thick, "A fixture pushes the hand"}
               : Mode{"ARMED", kDot, colour::kGood, Edge::Thin, meaningOfArmed(record.cause)};
}

const char* recordedWord(StepState state) {
    constexpr const char* kWords[]{"OFF", "FREE", "CONTACT", "ESCAPING", "TRAPPED", "FADING", "LAGS"};
    return kWords[static_cast<size_t>(state)];
}

// A line in pieces; along is of unit length.
void dashes(ImDrawList& list, ImVec2 from, ImVec2 to, ImU32 colour, float width) {
    const float length = std::hypot(to.x - from.x, to.y - from.y);
    const ImVec2 along{(to.x - from.x) / length, (to.y - from.y) / length};
    for (float s = 0.0f; s < length; s += 8.0f * width) {
        const float end = std::min(length, s + 4.0f * width);
        list.AddLine({from.x + along.x * s, from.y + along.y * s},
                     {from.x + along.x * end, from.y + along.y * end}, colour, width);
    }
}

// Short slanted lines along the inside of a rectangle.
void hatch(ImDrawList& list, ImVec2 a, ImVec2 b, ImU32 colour, float width) {
    const float step = 3.0f * width;
    for (float x = a.x; x < b.x; x += step) {
        list.AddLine({x, a.y + 2.0f * width}, {x + 2.0f * width, a.y}, colour, 0.5f * width);
        list.AddLine({x, b.y}, {x + 2.0f * width, b.y - 2.0f * width}, colour, 0.5f * width);
    }
    for (float y = a.y; y < b.y; y += step) {
        list.AddLine({a.x, y + 2.0f * width}, {a.x + 2.0f * width, y}, colour, 0.5f * width);
        list.AddLine({b.x - 2.0f * width, y + 2.0f * width}, {b.x, y}, colour, 0.5f * width);
    }
}

void drawEdge(ImDrawList& list, const Mode& mode, ImVec2 corner, ImVec2 size, float scale) {
    const float width = (mode.edge == Edge::Thin ? 3.0f : 6.0f) * scale, half = 0.5f * width;
    const ImVec2 a{corner.x + half, corner.y + half}, b{corner.x + size.x - half, corner.y + size.y - half};
    if (mode.edge == Edge::Dashed) {
        for (const auto& [from, to] : {std::pair{a, ImVec2{b.x, a.y}}, std::pair{ImVec2{b.x, a.y}, b},
                                       std::pair{b, ImVec2{a.x, b.y}}, std::pair{ImVec2{a.x, b.y}, a}}) {
            dashes(list, from, to, mode.colour, width);
        }
        return;
    }
    list.AddRect(a, b, mode.colour, 0.0f, 0, mode.edge == Edge::Double ? 0.6f * width : width);
    if (mode.edge == Edge::Double) {
        list.AddRect({a.x + 1.4f * width, a.y + 1.4f * width}, {b.x - 1.4f * width, b.y - 1.4f * width},
                     mode.colour, 0.0f, 0, 0.6f * width);
    } else if (mode.edge == Edge::Hatched) {
        hatch(list, {a.x + half, a.y + half}, {b.x - half, b.y - half}, mode.colour, width);
    }
}

} // namespace

Mode modeOf(const ModeInput& input) {
    if (input.console.timeLine.on) {
        return {"LOOK-BACK", "\xc2\xab", colour::kPicked, Edge::Dashed,
                "A recording is shown; nothing is live"};
    }
    if (!input.console.switches.forces) {
        return input.run.step().record.state == StepState::Fading
                   ? forcesFading("Forces are being switched off")
                   : forcesOff("The device gets no force. A: arm");
    }
    return armedMode(input);
}

namespace {

// Why forces that are on are missing or delayed. Without a word there is no reason.
Chip reasonChip(const ModeInput& input) {
    const StepRecord& record = input.run.step().record;
    if (record.state == StepState::Off && record.frame < 0) {
        return {"NO REGIONS YET", colour::kCaution, "No force before regions are known"};
    }
    if (record.state == StepState::Waiting) {
        return {"LAGS", colour::kCaution,
                "Late contacts or slow joints: no force until the tool has caught up"};
    }
    if (record.state == StepState::Escape) {
        return {"ESCAPING", colour::kCaution, "A region now covers the tool, which moves out"};
    }
    if (record.state == StepState::Off || record.state == StepState::Fading) {
        const LossCause cause = lossCause(input.run);
        return {cause.word, colour::kCaution, cause.meaning};
    }
    return {};
}

} // namespace

std::vector<Chip> chipsOf(const ModeInput& input) {
    const Console& console = input.console;
    const Console::Switches& switches = console.switches;
    const StepRecord& record = input.run.step().record;
    std::vector<Chip> chips;
    if (console.timeLine.on) {
        chips.push_back({recordedWord(record.state), colour::kText, "State at this moment of the recording"});
    }
    if (record.guidance > 0.0 || switches.guidance) {
        const std::vector<GuidancePose>& targets = input.run.scene().set.guidance;
        const bool any = std::ranges::any_of(targets, [](const GuidancePose& g) { return g.present; });
        chips.push_back({any || record.guidance > 0.0 ? "GUIDE" : "GUIDE: no target", colour::kGuidanceWord,
                         "Guidance is on: the tool is pulled to the nearest target. G: off"});
    }
    if (switches.forces && !console.timeLine.on) {
        if (Chip reason = reasonChip(input); !reason.word.empty()) {
            chips.push_back(std::move(reason));
        }
    }
    if (switches.clutch) {
        chips.push_back({"CLUTCH", colour::kText, "The hand moves, the tool stays"});
    }
    if (switches.frozen) {
        chips.push_back({"FROZEN", colour::kCaution, "New images do not change the fixtures. F: release"});
    }
    if (switches.recording) {
        chips.push_back({"REC " + console.status.recorded.text(), colour::kWarningWord,
                         "A recording runs: its time, its size, what is left on the disk. R: stop"});
    }
    return chips;
}

void drawMode(Console& console, const ModeInput& input, ImFont* font, ImVec2 corner, ImVec2 size) {
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    const Mode mode = modeOf(input);
    const float scale = console.scale(), pad = 8.0f * scale;
    drawEdge(list, mode, corner, size, scale);
    const std::string word = std::string(mode.sign) + " " + mode.word;
    const ImVec2 wordSize = font->CalcTextSizeA(font->FontSize, 1e9f, 0.0f, word.c_str());
    const std::vector<Chip> chips = chipsOf(input);
    float chipsWide = 0.0f;
    for (const Chip& chip : chips) {
        chipsWide += ImGui::CalcTextSize(chip.word.c_str()).x + 3.0f * pad;
    }
    const bool below = !chips.empty() && wordSize.x + 3.0f * pad + chipsWide > 0.9f * size.x; // a second row
    const float row = ImGui::GetTextLineHeight() + 1.2f * pad;
    const ImVec2 plate{below ? std::max(wordSize.x + 2.0f * pad, chipsWide)
                             : wordSize.x + 2.0f * pad + chipsWide,
                       wordSize.y + pad + (below ? row : 0.0f)};
    const ImVec2 at{corner.x + std::max(0.0f, 0.5f * (size.x - plate.x)), corner.y};
    list.AddRectFilled(at, {at.x + plate.x, at.y + plate.y}, colour::kPlate, 6.0f * scale,
                       ImDrawFlags_RoundCornersBottom);
    list.AddText(font, font->FontSize, {at.x + pad, at.y + 0.5f * pad}, mode.colour, word.c_str());
    float x = at.x + (below ? 2.0f * pad : wordSize.x + 3.0f * pad);
    const float middle = below ? at.y + wordSize.y + pad + 0.5f * row : at.y + 0.5f * plate.y;
    bool over = false; // a chip
    for (const Chip& chip : chips) {
        const ImVec2 text = ImGui::CalcTextSize(chip.word.c_str());
        const float y = middle - 0.5f * text.y;
        list.AddRect({x - pad, y - 0.3f * pad}, {x + text.x + pad, y + text.y + 0.3f * pad}, chip.colour,
                     4.0f * scale);
        list.AddText({x, y}, chip.colour, chip.word.c_str());
        over = explainArea(console, {x - pad, y - 0.3f * pad}, {text.x + 2.0f * pad, text.y + 0.6f * pad},
                           chip.meaning) ||
               over;
        x += text.x + 3.0f * pad;
    }
    markPlace(console, "mode", at, plate);
    if (!over) {
        explainArea(console, at, plate, mode.meaning);
    }
}

void drawRefusal(Console& console, ImFont* font, ImVec2 corner, ImVec2 size) {
    console.places.erase("refusal");
    if (console.messages.refusal.empty()) {
        return;
    }
    const std::string words = "Forces stay off: " + console.messages.refusal;
    const float letter = font->FontSize, wrap = std::min(0.8f * size.x, 34.0f * letter);
    const ImVec2 text = font->CalcTextSizeA(letter, wrap, wrap, words.c_str());
    const ImVec2 a{corner.x + 0.5f * (size.x - text.x) - letter,
                   corner.y + 0.5f * (size.y - text.y) - letter};
    const ImVec2 b{a.x + text.x + 2.0f * letter, a.y + text.y + 2.0f * letter};
    ImDrawList& list = *ImGui::GetForegroundDrawList(); // over the marks
    list.AddRectFilled(a, b, colour::kPlate, 6.0f);
    list.AddRect(a, b, colour::kWarning, 6.0f, 0, 3.0f);
    list.AddText(font, letter, {a.x + letter, a.y + letter}, colour::kText, words.c_str(), nullptr, wrap);
    markPlace(console, "refusal", a, {b.x - a.x, b.y - a.y});
}

} // namespace fathom::operate
