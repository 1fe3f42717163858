// SPDX-License-Identifier: Apache-2.0
#include "apps/operate/screen.h"

#include "apps/operate/closing.h"
#include "apps/operate/contact_tooltip.h"
#include "apps/operate/open_card.h"
#include "apps/operate/shape_marks.h"
#include "apps/operate/space_marks.h"
#include "apps/operate/stop_plate.h"
#include "apps/operate/tabs.h"
#include "apps/operate/view_click.h"
#include "apps/output/silhouette.h"

#include <algorithm>
#include <utility>

namespace fathom::operate {

namespace {

bool sameOrbit(const Orbit& a, const Orbit& b) {
    return a.yaw == b.yaw && a.pitch == b.pitch && a.distance == b.distance && a.centre == b.centre;
}

} // namespace

void Screen::makeImages(const Console& console, const FixtureEditor& editor, const ScreenInput& input,
                        const Rooms& rooms) {
    const Console::Settings& settings = console.settings;
    const bool all =
        !cameraPort_ || std::exchange(redraw_, false) || composed_.spaceIsLarge != settings.spaceIsLarge;
    if (const SceneSnapshot& scene = input.run.scene(); !centred_ && scene.any) {
        const SpaceBounds bounds = boundsOf(scene.set, input.arm);
        composed_.orbit.centre = bounds.middle;
        floor_ = bounds.floor;
        centred_ = true;
    }
    const bool camera = composeCamera(editor, input, all);
    const bool space = composeSpace(settings, input, settings.spaceIsLarge ? rooms.large : rooms.inset, all);
    waiting_ = {waiting_[0] || camera, waiting_[1] || space};
    placeImages(settings.spaceIsLarge, rooms);
}

bool Screen::composeCamera(const FixtureEditor& editor, const ScreenInput& input, bool all) {
    if (!input.freshImage && !all && composed_.selection == editor.selectionNumber()) {
        return false;
    }
    camera_.compose(input.run.scene(), editor.selection());
    composed_.selection = editor.selectionNumber();
    return true;
}

bool Screen::composeSpace(const Console::Settings& settings, const ScreenInput& input, const PixelRect& room,
                          bool all) {
    const SceneSnapshot& scene = input.run.scene();
    Orbit orbit = settings.orbit;
    orbit.centre = composed_.orbit.centre;
    // Two thirds of the resolution are enough for a cloud.
    const int parts = coarse_ ? 4 : 3;
    const auto width = static_cast<uint32_t>(std::clamp(room.width * 2 / parts, 64, 1200));
    const auto height = static_cast<uint32_t>(std::clamp(room.height * 2 / parts, 48, 900));
    const bool changed = all || !sameOrbit(orbit, composed_.orbit) ||
                         composed_.treeLevel != settings.treeLevel || width != space_.view().lens.width ||
                         height != space_.view().lens.height;
    const uint64_t rest = coarse_ ? 5 : 3; // frames per image of a small 3D view
    const bool due = settings.spaceIsLarge || scene.number >= composed_.spaceScene + rest;
    if (!changed && !(input.freshImage && due)) {
        return false;
    }
    space_.compose(scene, {orbit, floor_, width, height, settings.treeLevel}, input.arm);
    composed_.orbit = orbit;
    composed_.spaceScene = scene.number;
    composed_.treeLevel = settings.treeLevel;
    composed_.spaceIsLarge = settings.spaceIsLarge;
    return true;
}

void Screen::placeImages(bool spaceIsLarge, const Rooms& rooms) {
    const auto& camera = camera_.view();
    const auto& lens = space_.view().lens;
    const PixelRect& cameraRoom = spaceIsLarge ? rooms.inset : rooms.large;
    const PixelRect& spaceRoom = spaceIsLarge ? rooms.large : rooms.inset;
    cameraPort_ = ViewPort{camera, fitted(cameraRoom, camera.width(), camera.height())};
    spacePort_ = ViewPort{space_.view(), fitted(spaceRoom, lens.width, lens.height)};
    ViewPort& large = spaceIsLarge ? *spacePort_ : *cameraPort_;
    large.where.x = rooms.large.x; // free room, from another aspect ratio, is at the right
    large_ = &large;
    const auto none = std::span<const uint32_t>();
    const size_t under = spaceIsLarge ? 1 : 0; // the inset is drawn over the large view
    layers_[under] = {waiting_[0] ? std::span<const uint32_t>(camera_.pixels()) : none,
                      static_cast<uint32_t>(camera.width()), static_cast<uint32_t>(camera.height()),
                      cameraPort_->where};
    layers_[1 - under] = {waiting_[1] ? std::span<const uint32_t>(space_.pixels()) : none, lens.width,
                          lens.height, spacePort_->where};
}

// The depth under the pixels of a view. With separate cameras, parallax is ignored.
SurfaceDepth Screen::surfaceOf(const ViewPort& port, const HostFixtures& set) const {
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
    const double radius = gates.radius + 3.0 * editor.scene().registrationSigma; // as of the final regions
    const bool shown = console.pick.taken && gates.role == Role::Forbidden;
    if (shown && (ghost_.selection != editor.selectionNumber() || ghost_.radius != radius)) {
        ghost_.spheres = ghostOf(scene.set, editor.selection(), radius);
        ghost_.selection = editor.selectionNumber();
        ghost_.radius = radius;
    }
    if (!shown) {
        ghost_.spheres.clear();
        ghost_.selection = 0;
    }
    placed_ = shapeToPlace(console, editor, *this, scene.set);
    console.pick.warnings =
        placed_ ? coverWarnings(*placed_, cues_.tool, scene.set.guidance, editor.scene())
                : coverWarnings(ghost_.spheres, cues_.tool, scene.set.guidance, editor.scene());
    if (console.pick.taken && console.pick.found.others > 0) {
        console.pick.warnings.push_back("The fixture's box also contains " +
                                        std::to_string(console.pick.found.others) + " points of other parts");
    }
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
            drawScaleBar(list, *port, console.settings.orbit.distance);
        }
        const MarksInput marks{*port,     input.run,      input.tool, editor.scene(), editor.shapes(),
                               input.arm, input.measured, cues_,      surface,        large};
        drawGhost(list, *port, ghost_.spheres);
        if (placed_) {
            drawShape(list, *port, *placed_, ShapeLook::Ghost);
        }
        const double hidden = drawMarks(list, marks);
        if (large) {
            cues_.hidden = hidden;
            drawContactTooltip(console, list, marks);
        }
        const char* name = port == &*cameraPort_             ? "camera"
                           : console.settings.treeLevel >= 0 ? "3D, tree bounds"
                                                             : "3D";
        const float inside = large ? 18.0f * console.scale() : 8.0f; // of the frame
        drawWords(list, {corner.x + inside, corner.y + inside},
                  large ? name : std::string(name) + "   Tab: swap", colour::kQuiet);
        list.PopClipRect();
        markPlace(console, port == &*cameraPort_ ? "camera" : "space", corner, size);
    }
}

void Screen::drawOver(Console& console, const Alarms& alarms, const ScreenInput& input, const Rooms& rooms) {
    const ImVec2 corner = cornerOf(large_->where), size = sizeOf(large_->where);
    drawMode(console, {console, input.run, input.hud.haptics}, input.hud.fonts.large, corner, size);
    drawGapBar(console, cues_, input.hud.fonts, rooms.gap);
    if (!console.timeLine.on) { // nothing is live
        drawStop(console, input.hud.fonts, rooms.stop);
    }
    drawRefusal(console, input.hud.fonts.bold, corner, size);
    drawClosing(console, corner, size);
    drawOpenCard(console, corner, size);
    const float inside = 18.0f * console.scale(); // of the frame
    const auto& mode = console.places["mode"];
    const float below =
        std::max(corner.y + inside + 1.5f * ImGui::GetTextLineHeight(), mode[1] + mode[3] + 4.0f);
    drawAlarmLines(console, alarms, {corner.x + inside, below},
                   {0.6f * size.x, corner.y + size.y - below - 5.0f * ImGui::GetTextLineHeight()});
    drawHint(console, input.hud.driven, large_->where, rooms.stop);
}

void Screen::drawCloseUps(Console& console, const FixtureEditor& editor, const ScreenInput& input,
                          const CloseUpRooms& rooms) {
    for (const auto& [side, room] :
         {std::pair(CloseUpSide::Right, rooms.side), std::pair(CloseUpSide::Top, rooms.top)}) {
        auto& view = closeUps_[side == CloseUpSide::Right ? 0 : 1];
        view = closeUp(input.run.scene().set, cues_, side, room);
        console.places.erase(side == CloseUpSide::Right ? "close-up side" : "close-up top");
        if (view) {
            drawCloseUp(console, *view, side, cues_, editor.shapes(), input.hud.fonts.small);
        }
    }
}

// The parts that only the engineer's layout has.
void Screen::drawFigures(Console& console, const ScreenInput& input, const Rooms& rooms) {
    drawHeadLine(console, input.hud, cornerOf(rooms.head), sizeOf(rooms.head));
    ImGui::SetNextWindowPos(cornerOf(rooms.gauges));
    ImGui::SetNextWindowSize(sizeOf(rooms.gauges));
    ImGui::Begin("gauges", nullptr, kPanel);
    drawGauges(console, input.hud);
    ImGui::End();
}

void Screen::draw(Console& console, FixtureEditor& editor, Alarms& alarms, const ScreenInput& input) {
    console.messages.tooltip.clear();
    Rooms rooms = arrange({ImGui::GetIO().DisplaySize, console.status.drawnScale,
                           console.settings.pilotLayout, console.timeLine.on});
    makeImages(console, editor, input, rooms);
    if (!console.settings.pilotLayout) {
        besideView(rooms, large_->where, console.scale());
    }
    findCues(input);
    findGhost(console, editor, input.run.scene());
    drawViews(console, editor, input);
    if (console.settings.pilotLayout) {
        drawForceStrip(console, input.hud, rooms.strip);
    } else {
        drawFigures(console, input, rooms);
    }
    if (console.pick.active && console.panels.shownTab != Tab::Fixtures) {
        console.panels.tab = Tab::Fixtures;
    }
    const bool tabs = !console.settings.pilotLayout || console.panels.open || console.aims() ||
                      console.pick.active || console.panels.haveKeys;
    if (tabs) {
        drawTabs(console, editor, alarms, {input.run, input.hud}, rooms.tabs);
    }
    if (console.closing.stage == ClosingStage::No) {
        handleFixtureKeys(console, editor, input.run.scene());
    }
    rooms.gap = tabs && console.settings.pilotLayout ? PixelRect() : rooms.gap; // the tabs are over it
    drawCloseUps(console, editor, input, closeUpRooms(rooms.gap, console.scale()));
    drawOver(console, alarms, input, rooms);
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
