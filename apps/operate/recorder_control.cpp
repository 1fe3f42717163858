// SPDX-License-Identifier: Apache-2.0
#include "apps/operate/recorder_control.h"

#include "apps/binding/scene_files.h"

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

void RecorderControl::follow(Console& console, FixtureEditor& editor) {
    const bool writing = recorder_.writing();
    if (console.recording && folder_.empty() && !writing) {
        start(console, editor);
    } else if (!folder_.empty() && (!console.recording || !recorder_.recording())) {
        recorder_.stop();
        console.recording = false;
        if (recorder_.writing()) {
            return;
        }
        recorder_.finish();
        const std::string failure = recorder_.failure();
        const uint64_t lost = recorder_.lost();
        console.notify(std::to_string(recorder_.images()) + " frames recorded in " + folder_ +
                       (lost > 0 ? ", " + std::to_string(lost) + " skipped: the disk was too slow" : "") +
                       (failure.empty() ? "" : ", then: " + failure));
        folder_.clear();
    }
}

} // namespace fathom::operate
