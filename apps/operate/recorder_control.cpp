// SPDX-License-Identifier: Apache-2.0
#include "apps/operate/recorder_control.h"

#include "apps/binding/scene_files.h"
#include "engine/types/error.h"

#include <imgui.h>

namespace fathom::operate {

// The first unused folder name.
std::filesystem::path RecorderControl::freshFolder() {
    std::filesystem::path folder;
    do {
        folder = in_ / ("recording-" + std::to_string(++number_));
    } while (std::filesystem::exists(folder));
    return folder;
}

void RecorderControl::start(Console& console, FixtureEditor& editor) {
    try {
        const std::filesystem::path folder = freshFolder();
        disk_.look(folder, ImGui::GetTime());
        if (const std::string problem = disk_.problem(); !problem.empty()) {
            throw Error("not recording: " + problem);
        }
        editor.keep(console.settings(), session_.scene.pilot);
        const std::string left = copySceneFiles(session_.scene, folder); // before the recorder's own
        recorder_.start(folder, editor.text(), session_.camera->info(), recordedScene(editor));
        folder_ = folder.string();
        console.notify("recording to " + folder_ +
                       (left.empty() ? "" : ", without " + left + ": outside the scene file's folder"));
    } catch (const std::exception& e) {
        console.recording = false;
        console.notify(e.what());
    }
}

// Everything is on disk.
void RecorderControl::saved(Console& console) {
    recorder_.finish();
    const std::string failure = recorder_.failure();
    const uint64_t lost = recorder_.lost();
    console.notify("saved: " + std::to_string(recorder_.images()) + " frames recorded in " + folder_ + ", " +
                   clockText(recorder_.seconds()) + ", " + byteText(recorder_.bytes()) +
                   (lost > 0 ? ", " + std::to_string(lost) + " skipped: the disk was too slow" : "") +
                   (failure.empty() ? "" : ", then: " + failure));
    folder_.clear();
}

void RecorderControl::follow(Console& console, FixtureEditor& editor) {
    if (console.recording && folder_.empty() && !recorder_.writing()) {
        start(console, editor);
    } else if (!folder_.empty()) {
        disk_.look(folder_, ImGui::GetTime());
        if (const std::string problem = disk_.problem(); !problem.empty()) {
            recorder_.stop(problem);
        }
        if (!console.recording || !recorder_.recording()) {
            recorder_.stop();
            console.recording = false;
            if (!recorder_.writing()) {
                saved(console);
            }
        }
    }
    console.recorded = {recorder_.seconds(), recorder_.bytes(), disk_.left()};
}

} // namespace fathom::operate
