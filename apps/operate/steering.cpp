// SPDX-License-Identifier: Apache-2.0
#include "apps/operate/steering.h"

#include "apps/operate/keys.h"
#include "apps/operate/space_marks.h"

#include <GLFW/glfw3.h>
#include <algorithm>
#include <array>
#include <cmath>

namespace fathom::operate {

namespace {

constexpr double kSpeed = 0.12, kKeyRotation = 0.9;    // [m/s], [rad/s] while a key is down
constexpr double kWheel = 0.008;                       // [m] per notch
constexpr float kCursor = 240.0f, kSlowCursor = 30.0f; // [pixels/s] without and with Shift
constexpr double kClick = 4.0; // [pixels] a click may move this far before it is a drag

bool pressed(int key) {
    return keyPressed(key);
}

// Function keys that open a tab, and close it in the pilot's layout.
void openTabs(Console& console) {
    Console::Panels& panels = console.panels;
    for (const auto& [key, tab] : {std::pair(GLFW_KEY_F1, Tab::Help), std::pair(GLFW_KEY_F3, Tab::Camera),
                                   std::pair(GLFW_KEY_F4, Tab::Device)}) {
        if (pressed(key)) {
            panels.open = !panels.open || panels.shownTab != tab;
            panels.tab = tab;
        }
    }
}

} // namespace

std::span<const KeyHelp> keyHelp() {
    static constexpr std::array kHelp = {
        KeyHelp{"Space", "forces off, always"},
        KeyHelp{"A", "forces on, rising over 1.5 s or more"},
        KeyHelp{"G", "guidance on or off"},
        KeyHelp{"J", "close or open the jaws of an arm"},
        KeyHelp{"hold C", "clutch: the hand moves, the tool stays; with forces off, hand to tool"},
        KeyHelp{"left drag, wheel", "move the tool; wheel: along the view"},
        KeyHelp{"right drag", "rotate the tool; in the 3D view, rotate the view"},
        KeyHelp{"arrows, PgUp, PgDn", "move the tool; with Shift rotate it"},
        KeyHelp{"Tab", "swap camera and 3D view"},
        KeyHelp{"1, 2, 3, 0 or Z", "3D view from the front, the side, the top; reset"},
        KeyHelp{"T", "bounds of the region tree, next level"},
        KeyHelp{"F", "freeze the fixtures"},
        KeyHelp{"K", "pick a colour: click, or arrows and Enter; Enter adds it"},
        KeyHelp{"Ctrl Z, Ctrl Y", "undo, redo of fixtures"},
        KeyHelp{"Ctrl S", "save the fixtures to the scene file"},
        KeyHelp{"P, E", "pause the traces; write them as CSV"},
        KeyHelp{"W", "why the tool stopped; or point at the contact"},
        KeyHelp{"Q", "acknowledge alarms"},
        KeyHelp{"M", "tones on or off: contact, limit, old image, lost device"},
        KeyHelp{"R", "start or stop recording"},
        KeyHelp{"L", "store the seconds that are kept, up to 30, as a recording"},
        KeyHelp{"N", "mark this moment in the recording; the time line shows it"},
        KeyHelp{"in a recording",
                "Space plays; arrows: one frame, with Shift one tick; Home, End; [ ]: speed; comma, "
                "period: marks"},
        KeyHelp{"O", "open a recording: O chooses, Enter opens, Esc stays; forces go off"},
        KeyHelp{"X", "export a recording as a video, or as PNG files without ffmpeg; X or Esc stops"},
        KeyHelp{"F6", "keyboard to the panels: arrows choose, Enter presses; F6 or Esc: back"},
        KeyHelp{"F11", "full screen; Ctrl F11: recreate the swapchain"},
        KeyHelp{"F12", "screenshot"},
        KeyHelp{"Ctrl +, Ctrl -", "larger or smaller text"},
        KeyHelp{"F1", "this list"},
        KeyHelp{"F2", "pilot's layout: large views; engineer's layout: figures and traces"},
        KeyHelp{"F3", "camera: streams, delay, exposure, gain, laser"},
        KeyHelp{"F4", "device: what its buttons do; press one to map it"},
        KeyHelp{"Esc", "close a card, a panel or a pick"},
        KeyHelp{"D, Enter, Esc", "answer the question when the window closes"},
    };
    return kHelp;
}

Steering::Steering(const Pose& start, const Scene::Hand& hand)
    : raw_(start)
    , baseRdevice_(hand.baseRdevice)
    , scale_(hand.scale) {}

void Steering::shift(const dvec3& base) {
    raw_.position += glm::conjugate(baseRdevice_) * base / scale_;
}

void Steering::rotate(const dvec3& base) {
    raw_.rotation = glm::normalize(rotationExp(glm::conjugate(baseRdevice_) * base) * raw_.rotation);
}

void Steering::keys(Console& console) {
    Console::Switches& switches = console.switches;
    Console::Requests& requests = console.requests;
    Console::Settings& settings = console.settings;
    switches.forces = switches.forces || pressed(GLFW_KEY_A);
    switches.guidance = switches.guidance != pressed(GLFW_KEY_G);
    switches.grasp = switches.grasp != pressed(GLFW_KEY_J);
    switches.clutch = keyDown(GLFW_KEY_C);
    settings.spaceIsLarge = settings.spaceIsLarge != pressed(GLFW_KEY_TAB);
    console.panels.tracesPaused = console.panels.tracesPaused != pressed(GLFW_KEY_P);
    switches.frozen = switches.frozen != pressed(GLFW_KEY_F);
    switches.recording = switches.recording != pressed(GLFW_KEY_R);
    requests.exportImages = requests.exportImages || pressed(GLFW_KEY_X);
    requests.openCard = requests.openCard || pressed(GLFW_KEY_O);
    requests.mark = requests.mark || pressed(GLFW_KEY_N);
    requests.storeLast = requests.storeLast || pressed(GLFW_KEY_L);
    requests.exportTraces = requests.exportTraces || pressed(GLFW_KEY_E);
    requests.acknowledge = requests.acknowledge || pressed(GLFW_KEY_Q);
    if (pressed(GLFW_KEY_M)) {
        settings.tones = !settings.tones;
        console.notify(settings.tones ? "tones are on" : "tones are off");
    }
    if (pressed(GLFW_KEY_ESCAPE)) {
        console.messages.refusal.clear();
        console.editing.mapping.reset();
        console.panels.open = false;
    }
    if (pressed(GLFW_KEY_T)) {
        settings.treeLevel = settings.treeLevel >= 3 ? -1 : settings.treeLevel + 1;
    }
    lookByKeys(console);
    if (pressed(GLFW_KEY_K)) {
        console.pick = Pick{};
        console.pick.active = true;
    }
    if (pressed(GLFW_KEY_W)) {
        console.panels.open = !console.panels.open || console.panels.shownTab != Tab::Why;
        console.panels.tab = Tab::Why;
    }
}

// The 3D view's standard sides.
void Steering::lookByKeys(Console& console) {
    for (const auto& [key, side] : {std::pair(GLFW_KEY_1, Side::Front), std::pair(GLFW_KEY_2, Side::Right),
                                    std::pair(GLFW_KEY_3, Side::Top), std::pair(GLFW_KEY_0, Side::Reset),
                                    std::pair(GLFW_KEY_Z, Side::Reset)}) {
        if (pressed(key)) {
            lookFrom(console.settings.orbit, side);
        }
    }
}

// Moves the crosshair in the large view; Enter clicks there.
void Steering::moveCursor(Console& console, const ViewPort& large, const dvec3& direction) {
    const PixelRect& w = large.where;
    ImVec2 at =
        console.cursor.value_or(ImVec2(static_cast<float>(w.x) + 0.5f * static_cast<float>(w.width),
                                       static_cast<float>(w.y) + 0.5f * static_cast<float>(w.height)));
    const ImGuiIO& io = ImGui::GetIO();
    const float step = (io.KeyShift ? kSlowCursor : kCursor) * std::min(0.1f, io.DeltaTime);
    at.x = std::clamp(at.x + step * static_cast<float>(direction.x), static_cast<float>(w.x),
                      static_cast<float>(w.x + w.width - 1));
    at.y = std::clamp(at.y + step * static_cast<float>(direction.y), static_cast<float>(w.y),
                      static_cast<float>(w.y + w.height - 1));
    console.cursor = at;
}

void Steering::moveByKeys(Console& console, const ViewPort& large) {
    const ImGuiIO& io = ImGui::GetIO();
    if (io.WantTextInput || console.panels.haveKeys) {
        return;
    }
    const auto axis = [](int plus, int minus) {
        return (keyDown(plus) ? 1.0 : 0.0) - (keyDown(minus) ? 1.0 : 0.0);
    };
    const dvec3 direction(axis(GLFW_KEY_RIGHT, GLFW_KEY_LEFT), axis(GLFW_KEY_DOWN, GLFW_KEY_UP),
                          axis(GLFW_KEY_PAGE_UP, GLFW_KEY_PAGE_DOWN));
    if (direction == dvec3(0.0)) {
        return;
    }
    if (console.aims()) {
        moveCursor(console, large, direction);
        return;
    }
    const double dt = std::min(0.1, double{io.DeltaTime});
    const dquat baseReye = glm::conjugate(large.view.cameraTbase.rotation);
    if (io.KeyShift) {
        rotate(baseReye * (kKeyRotation * dt * dvec3(-direction.y, direction.x, direction.z)));
    } else {
        shift(baseReye * (kSpeed * dt * direction));
    }
}

void Steering::moveByMouse(Console& console, const ViewPort& large, double toolDepth) {
    Orbit& orbit = console.settings.orbit;
    const ImGuiIO& io = ImGui::GetIO();
    const dquat baseReye = glm::conjugate(large.view.cameraTbase.rotation);
    if (dragging_ && !console.pick.active && console.placing.shape == ShapeKind::None && toolDepth > 0.0) {
        const double metres = large.metresPerPixel(toolDepth);
        shift(baseReye * dvec3(metres * io.MouseDelta.x, metres * io.MouseDelta.y, 0.0));
    }
    if (orbiting_ && console.settings.spaceIsLarge) {
        orbit.yaw += 0.006 * io.MouseDelta.x;
        orbit.pitch = std::clamp(orbit.pitch + 0.006 * io.MouseDelta.y, -1.5, 1.5);
    } else if (orbiting_) {
        rotate(baseReye * (0.006 * dvec3(-io.MouseDelta.y, io.MouseDelta.x, 0.0)));
    }
    if (io.MouseWheel != 0.0f && large.holds(io.MousePos) && !io.WantCaptureMouse) {
        if (io.KeyCtrl && console.settings.spaceIsLarge) {
            orbit.distance = std::clamp(orbit.distance * std::pow(0.9, double{io.MouseWheel}), 0.15, 8.0);
        } else {
            shift(baseReye * dvec3(0.0, 0.0, kWheel * io.MouseWheel));
        }
    }
}

// The arrow keys move the tool or the cursor unless F6 gives them to the panels.
void Steering::switchFocus(Console& console) {
    bool& haveKeys = console.panels.haveKeys;
    ImGuiIO& io = ImGui::GetIO();
    if (pressed(GLFW_KEY_F6)) {
        haveKeys = !haveKeys;
        if (haveKeys) {
            ImGui::SetWindowFocus("panels");
        }
    }
    haveKeys = haveKeys && !(pressed(GLFW_KEY_ESCAPE) && !ImGui::IsAnyItemActive());
    io.ConfigFlags = haveKeys ? io.ConfigFlags | ImGuiConfigFlags_NavEnableKeyboard
                              : io.ConfigFlags & ~ImGuiConfigFlags_NavEnableKeyboard;
}

std::optional<ImVec2> Steering::step(Console& console, const ViewPort& large, double toolDepth) {
    ImGuiIO& io = ImGui::GetIO();
    Console::Settings& settings = console.settings;
    Console::Requests& requests = console.requests;
    if (!io.WantTextInput && !io.KeyCtrl) {
        keys(console);
    }
    openTabs(console);
    if (pressed(GLFW_KEY_F2)) {
        settings.pilotLayout = !settings.pilotLayout;
        console.panels.open = false;
    }
    switchFocus(console);
    if (pressed(GLFW_KEY_F11)) {
        requests.newSwapchain = requests.newSwapchain || io.KeyCtrl;
        settings.fullScreen = settings.fullScreen != !io.KeyCtrl;
    }
    requests.screenshot = requests.screenshot || pressed(GLFW_KEY_F12);
    if (io.KeyCtrl && (pressed(GLFW_KEY_EQUAL) || pressed(GLFW_KEY_KP_ADD))) {
        settings.textScale = std::min(2.5, settings.textScale + 0.125);
    }
    if (io.KeyCtrl && (pressed(GLFW_KEY_MINUS) || pressed(GLFW_KEY_KP_SUBTRACT))) {
        settings.textScale = std::max(0.75, settings.textScale - 0.125);
    }
    const bool enters =
        console.aims() && console.cursor && !console.panels.haveKeys && pressed(GLFW_KEY_ENTER);
    moveByKeys(console, large);
    const std::optional<ImVec2> clicked = clickByMouse(large);
    moveByMouse(console, large, toolDepth);
    dragging_ = dragging_ && ImGui::IsMouseDown(0);
    orbiting_ = orbiting_ && ImGui::IsMouseDown(1);
    const std::optional<ImVec2> taken = enters ? console.cursor : clicked;
    if (taken || !console.aims()) {
        console.cursor.reset();
    }
    return taken;
}

std::optional<ImVec2> Steering::clickByMouse(const ViewPort& large) {
    const ImGuiIO& io = ImGui::GetIO();
    const bool inside = large.holds(io.MousePos) && !io.WantCaptureMouse;
    for (int button : {0, 1}) {
        bool& held = button == 0 ? dragging_ : orbiting_;
        if (ImGui::IsMouseClicked(button) && inside) {
            held = true;
            travelled_ = 0.0;
        }
    }
    travelled_ += std::hypot(double{io.MouseDelta.x}, double{io.MouseDelta.y});
    const bool clicked = dragging_ && ImGui::IsMouseReleased(0) && travelled_ < kClick;
    return clicked ? std::optional(io.MousePos) : std::nullopt;
}

} // namespace fathom::operate
