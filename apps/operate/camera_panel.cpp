// SPDX-License-Identifier: Apache-2.0
#include "apps/operate/camera_panel.h"

#include "engine/types/printed.h"

#include <algorithm>
#include <cmath>

namespace fathom::operate {

namespace {

void streamRows(const CameraFacts& camera) {
    for (const CameraStream& s : camera.streams) {
        const std::string rate =
            s.rate > 0.0 ? printed("%.0f Hz", s.rate) : std::string("rate of the source");
        ImGui::TextUnformatted(
            printed("%s  %ux%u  %s  %s", s.name.c_str(), s.width, s.height, rate.c_str(), s.format.c_str())
                .c_str());
    }
}

void delayRow(Console& console, const CameraFacts& camera, const RunView& run, const Fonts& fonts) {
    const FrameDelay delay = run.delay();
    const std::string text =
        std::isfinite(delay.median)
            ? printed("Exposure to force %.0f ms, at most %.0f ms", 1e3 * delay.median, 1e3 * delay.worst)
            : std::string("Exposure to force: no frame in the last second");
    fontText(fonts.bold, colour::kText, text);
    markPlace(console, "exposure to force");
    explain(console, "From the capture time of a frame to the first tick whose force uses it: median and "
                     "largest of the last second");
    ImGui::PushTextWrapPos(0.0f);
    fontText(fonts.small, colour::kQuiet,
             camera.stampsExposure ? "counted from the start of exposure, which the camera reports"
             : camera.live ? "counted from the arrival of the image: exposure and transfer come on top"
                           : "counted from the time of the frame in the recording or simulation");
    ImGui::PopTextWrapPos();
}

// Draws the control. True when the pilot has chosen a new value.
bool controlWidget(Console& console, const CameraControl& control, int64_t& value) {
    Console::Editing& editing = console.editing;
    if (control.isSwitch) {
        bool on = value != 0;
        const bool changed = ImGui::Checkbox(control.name.c_str(), &on);
        value = on ? 1 : 0;
        return changed;
    }
    const std::string key = control.stream + " " + control.name;
    const bool dragged = editing.control == key;
    int shown = static_cast<int>(dragged ? editing.controlValue : value);
    ImGui::SetNextItemWidth(-1.0f);
    if (ImGui::SliderInt("##value", &shown, static_cast<int>(control.least), static_cast<int>(control.most),
                         (control.name + " %d " + control.unit).c_str())) {
        editing.control = key;
        editing.controlValue = shown;
    }
    const bool done = ImGui::IsItemDeactivatedAfterEdit();
    if (done) {
        const int64_t steps =
            std::llround(static_cast<double>(shown - control.least) / static_cast<double>(control.step));
        value = std::clamp(control.least + steps * control.step, control.least, control.most);
    }
    if (dragged && !ImGui::IsItemActive()) {
        editing.control.clear();
    }
    return done;
}

void controlRow(Console& console, const CameraControl& control, CameraControlThread& controlThread) {
    ImGui::PushID((control.stream + control.name).c_str());
    if (!control.fixed.empty()) {
        const bool measured = control.most > control.least;
        ImGui::PushTextWrapPos(0.0f);
        ImGui::TextDisabled(
            "%s", (control.name +
                   (measured ? printed(" %lld ", static_cast<long long>(control.value)) + control.unit
                             : std::string()) +
                   ": " + control.fixed)
                      .c_str());
        ImGui::PopTextWrapPos();
    } else if (int64_t value = control.value; controlWidget(console, control, value)) {
        controlThread.request(control, value);
        console.notify(control.stream + " " + control.name + ": " + std::to_string(value));
    }
    markPlace(console, control.stream + " " + control.name);
    explain(console, "A value of the camera itself. It applies at once, also for other programs, and stays "
                     "until the camera is unplugged");
    ImGui::PopID();
}

} // namespace

std::string whyNoControls(const CameraFacts& camera, const CameraControlThread& controlThread) {
    return controlThread.any() ? ""
           : camera.live       ? "Fathom can set no controls of this kind of camera."
                               : "A recording or simulation has no exposure, gain or laser to set.";
}

void drawCamera(Console& console, const CameraFacts& camera, const RunView& run,
                CameraControlThread& controlThread, const Fonts& fonts) {
    ImGui::PushTextWrapPos(0.0f);
    fontText(fonts.small, colour::kQuiet, camera.description);
    ImGui::PopTextWrapPos();
    streamRows(camera);
    delayRow(console, camera, run, fonts);
    ImGui::Separator();
    if (const std::string why = whyNoControls(camera, controlThread); !why.empty()) {
        ImGui::PushTextWrapPos(0.0f);
        ImGui::TextDisabled("%s", why.c_str());
        ImGui::PopTextWrapPos();
        markPlace(console, "no controls");
        explain(console,
                "Live V4L2 cameras have exposure, gain, white balance and, by their driver, a laser");
        return;
    }
    const CameraControlThread::Answer answer = controlThread.answer();
    if (!answer.fault.empty()) {
        colouredText(colour::kCaution, answer.fault.c_str());
    }
    if (!answer.known || answer.controls.empty()) {
        ImGui::TextDisabled("%s", answer.known ? "the camera is disconnected" : "asking the camera ...");
        return;
    }
    std::string stream;
    for (const CameraControl& control : answer.controls) {
        if (control.stream != stream) {
            stream = control.stream;
            fontText(fonts.bold, colour::kText, stream == "depth" ? "Depth" : "Colour");
        }
        controlRow(console, control, controlThread);
    }
}

} // namespace fathom::operate
