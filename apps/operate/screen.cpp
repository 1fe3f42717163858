// SPDX-License-Identifier: Apache-2.0
#include "apps/operate/screen.h"

#include "apps/operate/closing.h"
#include "apps/operate/contact_tooltip.h"
#include "apps/operate/space_marks.h"
#include "apps/operate/steering.h"
#include "apps/operate/why_panel.h"
#include "apps/replay/silhouette.h"

#include <algorithm>
#include <utility>

namespace fathom::operate {

namespace {

constexpr ImGuiWindowFlags kFixed = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                                    ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoBringToFrontOnFocus;

bool sameOrbit(const Orbit& a, const Orbit& b) {
    return a.yaw == b.yaw && a.pitch == b.pitch && a.distance == b.distance && a.centre == b.centre;
}

} // namespace

void Screen::makeImages(const Console& console, const FixtureEditor& editor, const ScreenInput& input,
                        const Rooms& rooms) {
    const SceneSnapshot& scene = input.run.scene();
    const bool newSelection = selectionDrawn_ != editor.selectionNumber();
    const bool first = !cameraPort_ || std::exchange(redraw_, false);
    if (!centred_ && scene.any) {
        const SpaceBounds bounds = boundsOf(scene.set, input.arm);
        drawnOrbit_.centre = bounds.middle;
        floor_ = bounds.floor;
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
        space_.compose(scene, {orbit, floor_, width, height, console.treeLevel}, input.arm);
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

// The depth under the pixels of a view. With separate cameras, parallax is ignored.
SurfaceDepth Screen::surfaceOf(const ViewPort& port, const Fixtures& set) const {
    if (&port == &*spacePort_) {
        return [this](glm::dvec2 p) { return space_.depthAt(p); };
    }
    const ImageView& view = port.view;
    return [&view, &set](glm::dvec2 p) {
        const double x = p.x / view.width(), y = p.y / view.height();
        return surfaceAt(set, x * set.camera.depth.width, y * set.camera.depth.height);
    };
}

void Screen::findCues(const ScreenInput& input) {
    const StepRecord& record = input.run.step().record;
    std::vector<Sphere> tool;
    if (input.run.anyTick() && isFinite(record.tool)) {
        tool.assign(input.arm.begin(), input.arm.end());
        for (const Sphere& leaf : input.arm.empty() ? input.tool.leaves() : std::span<const Sphere>()) {
            tool.push_back({record.tool.apply(leaf.centre), leaf.radius});
        }
    }
    cues_ = depthCues(input.run.scene().set, std::move(tool), record.clearance);
}

void Screen::findGhost(Console& console, const FixtureEditor& editor, const SceneSnapshot& scene) {
    const FixtureClass& gates = console.pick.gates;
    const bool shown = console.pick.taken && gates.role == Role::Forbidden;
    if (shown && (ghostNumber_ != editor.selectionNumber() || ghostRadius_ != gates.radius)) {
        ghost_ = ghostOf(scene.set, editor.selection(), gates.radius);
        ghostNumber_ = editor.selectionNumber();
        ghostRadius_ = gates.radius;
    }
    if (!shown) {
        ghost_.clear();
        ghostNumber_ = 0;
    }
    console.pick.warnings = coverWarnings(ghost_, cues_.tool, scene.set.guidance, editor.scene());
}

void Screen::drawViews(Console& console, const FixtureEditor& editor, const ScreenInput& input) {
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    for (const ViewPort* port : {&*cameraPort_, &*spacePort_}) {
        const PixelRect& w = port->where;
        const bool large = port == large_;
        const ImVec2 corner = cornerOf(w), size = sizeOf(w);
        list.PushClipRect(corner, {corner.x + size.x, corner.y + size.y});
        const SurfaceDepth surface = surfaceOf(*port, input.run.scene().set);
        if (port == &*cameraPort_) {
            drawRegionOutlines(list, *port, camera_);
        } else {
            drawCameraFrustum(list, *port, input.run.scene().set);
            drawBounds(list, *port, space_.bounds());
            drawAxes(list, *port, large);
            drawScaleBar(list, *port, console.orbit.distance);
        }
        const MarksInput marks{*port,     input.run,      input.tool, editor.scene(), editor.shapes(),
                               input.arm, input.measured, cues_,      surface,        large};
        drawGhost(list, *port, ghost_);
        const double hidden = drawMarks(list, marks);
        if (large) {
            cues_.hidden = hidden;
            drawContactTooltip(console, list, marks);
        }
        const char* name = port == &*cameraPort_    ? "camera"
                           : console.treeLevel >= 0 ? "3D, tree bounds"
                                                    : "3D";
        const float inside = large ? 18.0f * static_cast<float>(console.textScale) : 8.0f; // of the frame
        drawWords(list, {corner.x + inside, corner.y + inside},
                  large ? name : std::string(name) + "   Tab: swap", colour::kQuiet);
        list.PopClipRect();
        markPlace(console, port == &*cameraPort_ ? "camera" : "space", corner, size);
    }
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
    if (console.spaceIsLarge) {
        return "Right drag: turn the view   1 2 3: front, side, top   0: reset   Ctrl+wheel: distance   Tab: "
               "camera"
               "   F1: all keys";
    }
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
    const float inside = 18.0f * static_cast<float>(console.textScale); // of the frame
    const float x = static_cast<float>(w.x) + inside,
                bottom = static_cast<float>(w.y + w.height) - 0.6f * inside;
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
    findCues(input);
    findGhost(console, editor, input.run.scene());
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
    drawGapBar(console, cues_, input.hud.letters, cornerOf(large_->where), sizeOf(large_->where));
    drawRefusal(console, input.hud.letters.bold, cornerOf(large_->where), sizeOf(large_->where));
    drawClosing(console, cornerOf(large_->where), sizeOf(large_->where));
    const float inside = 18.0f * static_cast<float>(console.textScale); // of the frame
    const ImVec2 corner = cornerOf(large_->where);
    drawAlarmLines(console, alarms,
                   {corner.x + inside, corner.y + inside + 1.5f * ImGui::GetTextLineHeight()},
                   0.55f * sizeOf(large_->where).x);
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
