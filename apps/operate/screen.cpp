// SPDX-License-Identifier: Apache-2.0
#include "apps/operate/screen.h"

#include "apps/operate/closing.h"
#include "apps/operate/contact_tooltip.h"
#include "apps/operate/steering.h"
#include "apps/operate/why_panel.h"
#include "apps/replay/silhouette.h"

#include <algorithm>
#include <utility>

namespace fathom::operate {

namespace {

constexpr ImGuiWindowFlags kFixed = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                                    ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoBringToFrontOnFocus;

ImVec2 cornerOf(const PixelRect& r) {
    return {static_cast<float>(r.x), static_cast<float>(r.y)};
}

ImVec2 sizeOf(const PixelRect& r) {
    return {static_cast<float>(r.width), static_cast<float>(r.height)};
}

bool sameOrbit(const Orbit& a, const Orbit& b) {
    return a.yaw == b.yaw && a.pitch == b.pitch && a.distance == b.distance && a.centre == b.centre;
}

// Centre of regions and arm; without regions, the median depth of the camera on its axis.
dvec3 middleOf(const Fixtures& set, std::span<const Sphere> arm) {
    if (!set.spheres.x.empty()) {
        dvec3 low(1e300), high(-1e300);
        for (size_t i = 0; i < set.spheres.x.size(); ++i) {
            low = glm::min(low, regionCentre(set, i)), high = glm::max(high, regionCentre(set, i));
        }
        for (const Sphere& s : arm) {
            low = glm::min(low, s.centre), high = glm::max(high, s.centre);
        }
        return 0.5 * (low + high);
    }
    std::vector<uint16_t> near;
    for (size_t i = 0; i < set.depth.size(); i += 37) {
        if (set.depth[i] != 0) {
            near.push_back(set.depth[i]);
        }
    }
    if (near.empty()) {
        return {0.0, 0.0, 1.0};
    }
    std::nth_element(near.begin(), near.begin() + static_cast<std::ptrdiff_t>(near.size() / 2), near.end());
    return set.baseTcamera.apply({0.0, 0.0, near[near.size() / 2] * set.camera.metresPerUnit});
}

} // namespace

Screen::Rooms Screen::arrange(ImVec2 size, double scale, bool timeLine) {
    constexpr int kGap = 6;
    const int width = static_cast<int>(size.x), height = static_cast<int>(size.y);
    const int head = static_cast<int>(58 * scale), right = std::min(static_cast<int>(376 * scale), width / 2);
    const int traces = std::min(static_cast<int>(172 * scale), height / 3);
    const int gauges = std::min(static_cast<int>(168 * scale), height / 3);
    const int left = width - right - kGap, inset = std::max(60, std::min(right * 9 / 16, height / 3));
    Rooms rooms;
    rooms.head = {0, 0, width, head};
    const int strip = timeLine ? static_cast<int>(76 * scale) + kGap : 0;
    rooms.large = {0, head + kGap, left, height - head - traces - strip - 2 * kGap};
    rooms.timeLine = {0, height - traces - strip, left, std::max(0, strip - kGap)};
    rooms.traces = {0, height - traces, left, traces};
    rooms.inset = {left + kGap, head + kGap, right, inset};
    rooms.gauges = {left + kGap, head + inset + 2 * kGap, right, gauges};
    const int top = rooms.gauges.y + gauges + kGap;
    rooms.tabs = {left + kGap, top, right, std::max(40, height - top)};
    return rooms;
}

void Screen::makeImages(const Console& console, const FixtureEditor& editor, const ScreenInput& input,
                        const Rooms& rooms) {
    const SceneSnapshot& scene = input.run.scene();
    const bool newSelection = selectionDrawn_ != editor.selectionNumber();
    const bool first = !cameraPort_ || std::exchange(redraw_, false);
    if (!centred_ && scene.any) {
        drawnOrbit_.centre = middleOf(scene.set, input.arm);
        centred_ = true;
    }
    const bool fresh = input.freshImage || newSelection || first;
    if (fresh) {
        camera_.compose(scene, editor.selection());
        selectionDrawn_ = editor.selectionNumber();
    }
    const PixelRect& spaceRoom = console.spaceIsLarge ? rooms.large : rooms.inset;
    Orbit orbit = console.orbit;
    orbit.centre = drawnOrbit_.centre;
    const bool moved = !sameOrbit(orbit, drawnOrbit_) || drawnLevel_ != console.treeLevel ||
                       drawnLarge_ != console.spaceIsLarge;
    // Two thirds of the resolution are enough for a cloud.
    const auto width = static_cast<uint32_t>(std::clamp(spaceRoom.width * 2 / 3, 64, 1200));
    const auto height = static_cast<uint32_t>(std::clamp(spaceRoom.height * 2 / 3, 48, 900));
    const bool space = first || moved || width != space_.view().lens.width ||
                       height != space_.view().lens.height ||
                       (input.freshImage && (console.spaceIsLarge || scene.number % 3 == 0));
    if (space) {
        space_.compose(scene, orbit, width, height, console.treeLevel, input.arm);
        drawnOrbit_ = orbit;
        drawnLevel_ = console.treeLevel;
        drawnLarge_ = console.spaceIsLarge;
    }
    const PixelRect& cameraRoom = console.spaceIsLarge ? rooms.inset : rooms.large;
    cameraPort_ =
        ViewPort{camera_.view(), fitted(cameraRoom, camera_.view().width(), camera_.view().height())};
    spacePort_ = ViewPort{space_.view(), fitted(spaceRoom, width, height)};
    large_ = console.spaceIsLarge ? &*spacePort_ : &*cameraPort_;
    const auto none = std::span<const uint32_t>();
    layers_[0] = {fresh ? std::span<const uint32_t>(camera_.pixels()) : none,
                  static_cast<uint32_t>(camera_.view().width()),
                  static_cast<uint32_t>(camera_.view().height()), cameraPort_->where};
    layers_[1] = {space ? std::span<const uint32_t>(space_.pixels()) : none, width, height,
                  spacePort_->where};
}

void Screen::drawViews(Console& console, const FixtureEditor& editor, const ScreenInput& input) {
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    for (const ViewPort* port : {&*cameraPort_, &*spacePort_}) {
        const PixelRect& w = port->where;
        const bool large = port == large_;
        const ImVec2 corner = cornerOf(w), size = sizeOf(w);
        list.PushClipRect(corner, {corner.x + size.x, corner.y + size.y});
        if (port == &*cameraPort_) {
            drawRegionOutlines(list, *port, camera_);
        } else {
            drawCameraFrustum(list, *port, input.run.scene().set);
            drawBounds(list, *port, space_.bounds());
        }
        const MarksInput marks{*port,           input.run, input.tool,     editor.scene(),
                               editor.shapes(), input.arm, input.measured, large};
        drawMarks(list, marks);
        if (large) {
            drawContactTooltip(console, list, marks);
        }
        const char* name = port == &*cameraPort_    ? "camera"
                           : console.treeLevel >= 0 ? "3D, tree bounds"
                                                    : "3D";
        drawWords(list, {corner.x + 8.0f, corner.y + 6.0f}, large ? name : std::string(name) + "   Tab: swap",
                  colour::kQuiet);
        list.PopClipRect();
        markPlace(console, port == &*cameraPort_ ? "camera" : "space", corner, size);
    }
}

// The worst alarm as text, below the name of the large view.
void Screen::drawAlarm(Console& console, const Alarms& alarms) const {
    console.places.erase("alarm");
    const Alarm* worst = alarms.worst();
    if (worst == nullptr) {
        return;
    }
    const std::string words =
        std::string(levelSign(worst->level)) + " " + worst->words + (worst->active ? "   Q" : " (over)   Q");
    const float line = ImGui::GetTextLineHeight();
    const ImVec2 at{static_cast<float>(large_->where.x) + 10.0f,
                    static_cast<float>(large_->where.y) + 1.2f * line + 8.0f};
    drawWords(*ImGui::GetBackgroundDrawList(), at, words, levelColour(worst->level));
    markPlace(console, "alarm", at, {ImGui::CalcTextSize(words.c_str()).x, line});
}

namespace {

// The keys that are useful in the present state.
std::string hintOf(const Console& console, bool driven) {
    if (console.timeLine.on) {
        return "Recording.   Drag the time line   Space: play   arrows: frames, with Shift ticks   [ ]: "
               "speed   "
               "Tab: 3D   F1: all keys";
    }
    if (console.aims()) {
        return "Click, or use arrows (Shift: slowly) and Enter   Esc: cancel";
    }
    if (console.panels) {
        return "Keyboard in the panels: arrows choose, Enter presses   Space: forces off   F6, Esc: back";
    }
    const std::string moves = driven ? "" : "drag, wheel, arrows: tool   ";
    const std::string hint = console.forces ? "Space: forces off   G: guidance   " + moves + "F1: all keys"
                                            : "A: arm the forces   " + moves + "Tab: 3D   F1: all keys";
    return driven ? hint : "No haptic device: mouse and keyboard drive.   " + hint;
}

} // namespace

// The keyboard cursor, and the hint at the lower edge of the large view.
void Screen::drawHint(Console& console, const ScreenInput& input) const {
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    if (console.cursor) {
        const ImVec2 c = *console.cursor;
        list.AddCircle(c, 9.0f, colour::kPicked, 0, 2.0f);
        list.AddLine({c.x - 14.0f, c.y}, {c.x + 14.0f, c.y}, colour::kPicked);
        list.AddLine({c.x, c.y - 14.0f}, {c.x, c.y + 14.0f}, colour::kPicked);
    }
    const PixelRect& w = large_->where;
    const auto x = static_cast<float>(w.x) + 10.0f, bottom = static_cast<float>(w.y + w.height);
    const float line = ImGui::GetTextLineHeight() + 6.0f;
    drawWords(list, {x, bottom - line}, hintOf(console, input.hud.driven), colour::kText);
    if (ImGui::GetTime() < console.noticeUntil) {
        drawWords(list, {x, bottom - 2.2f * line}, console.notice, colour::kPicked);
    }
}

void Screen::drawTabs(Console& console, FixtureEditor& editor, Alarms& alarms, const ScreenInput& input,
                      const PixelRect& room) {
    ImGui::SetNextWindowPos(cornerOf(room));
    ImGui::SetNextWindowSize(sizeOf(room));
    ImGui::Begin("panels", nullptr, kFixed);
    constexpr const char* kNames[] = {"Fixtures", "Why?", "Alarms", "Keys"};
    if (ImGui::BeginTabBar("tabs")) {
        for (Tab tab : {Tab::Fixtures, Tab::Why, Tab::Alarms, Tab::Help}) {
            const bool wanted = console.tab == tab && console.shownTab != tab;
            const Alarm* worst = alarms.worst();
            const bool calls = tab == Tab::Alarms && worst != nullptr;
            const std::string name = std::string(kNames[static_cast<int>(tab)]) +
                                     (calls ? std::string(" ") + levelSign(worst->level) : "") + "###" +
                                     kNames[static_cast<int>(tab)];
            if (calls) {
                ImGui::PushStyleColor(ImGuiCol_Text, levelColour(worst->level));
            }
            const bool open =
                ImGui::BeginTabItem(name.c_str(), nullptr, wanted ? ImGuiTabItemFlags_SetSelected : 0);
            markPlace(console, std::string("tab ") + kNames[static_cast<int>(tab)]);
            if (calls) {
                ImGui::PopStyleColor();
            }
            if (!open) {
                continue;
            }
            console.tab = wanted || console.tab == console.shownTab ? tab : console.tab;
            console.shownTab = tab;
            ImGui::BeginChild("inside", ImVec2(0.0f, 0.0f), false, ImGuiWindowFlags_NavFlattened);
            if (tab == Tab::Fixtures) {
                drawFixtures(console, editor, input.run.scene());
            } else if (tab == Tab::Why) {
                drawWhy(input.run, editor.scene(), input.hud.armHolds);
            } else if (tab == Tab::Alarms) {
                drawAlarms(console, alarms);
            } else {
                for (const KeyHelp& help : keyHelp()) {
                    ImGui::TextColored(ImColor(colour::kGuidance), "%s", help.keys);
                    ImGui::SameLine(150.0f * static_cast<float>(console.textScale));
                    ImGui::TextUnformatted(help.what);
                }
            }
            ImGui::EndChild();
            ImGui::EndTabItem();
        }
        ImGui::EndTabBar();
    }
    ImGui::End();
}

void Screen::draw(Console& console, FixtureEditor& editor, Alarms& alarms, const ScreenInput& input) {
    const Rooms rooms = arrange(ImGui::GetIO().DisplaySize, console.textScale, console.timeLine.on);
    makeImages(console, editor, input, rooms);
    drawViews(console, editor, input);
    drawHeadLine(console, input.hud, cornerOf(rooms.head), sizeOf(rooms.head));
    ImGui::SetNextWindowPos(cornerOf(rooms.gauges));
    ImGui::SetNextWindowSize(sizeOf(rooms.gauges));
    ImGui::Begin("gauges", nullptr, kFixed);
    drawGauges(console, input.hud);
    ImGui::End();
    if (console.pick.active && console.shownTab != Tab::Fixtures) {
        console.tab = Tab::Fixtures;
    }
    drawTabs(console, editor, alarms, input, rooms.tabs);
    if (console.closing == Closing::No) {
        handleFixtureKeys(console, editor, input.run.scene());
    }
    drawMode(console, {console, input.run, input.hud.haptics}, input.hud.letters.large,
             cornerOf(large_->where), sizeOf(large_->where));
    drawRefusal(console, input.hud.letters.bold, cornerOf(large_->where), sizeOf(large_->where));
    drawClosing(console, cornerOf(large_->where), sizeOf(large_->where));
    drawAlarm(console, alarms);
    drawHint(console, input);
    markPlace(console, "traces room", cornerOf(rooms.traces), sizeOf(rooms.traces));
    markPlace(console, "time line room", cornerOf(rooms.timeLine), sizeOf(rooms.timeLine));
}

std::optional<glm::uvec2> Screen::colourPixelAt(ImVec2 at) const {
    if (!cameraPort_ || !cameraPort_->holds(at)) {
        return std::nullopt;
    }
    const glm::dvec2 p = cameraPort_->toImage(at) / static_cast<double>(camera_.view().scale);
    const Intrinsics& lens = camera_.view().lens;
    return glm::uvec2(std::min(lens.width - 1, static_cast<uint32_t>(p.x)),
                      std::min(lens.height - 1, static_cast<uint32_t>(p.y)));
}

} // namespace fathom::operate
