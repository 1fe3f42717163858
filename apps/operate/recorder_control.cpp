// SPDX-License-Identifier: Apache-2.0
#include "apps/operate/recorder_control.h"

#include "apps/binding/scene_files.h"
#include "apps/operate/unused_name.h"
#include "engine/types/error.h"
#include "engine/types/printed.h"

#include <imgui.h>
#include <utility>

namespace fathom::operate {

std::filesystem::path RecorderControl::freshFolder() const {
    return unusedName(in_, "recording", {""});
}

namespace {

std::string missingText(const std::string& skipped) {
    return skipped.empty() ? "" : ", without " + skipped + ": outside the scene file's folder";
}

} // namespace

void RecorderControl::start(Console& console, FixtureEditor& editor) {
    try {
        const std::filesystem::path folder = freshFolder();
        disk_.look(folder, ImGui::GetTime());
        if (const std::string problem = disk_.problem(); !problem.empty()) {
            throw Error("not recording: " + problem);
        }
        editor.keepSettings(console.settings.saved(), session_.scene.pilot);
        const std::string skipped = copySceneFiles(session_.scene, folder); // before the recorder's own
        recorder_.start(folder, editor.text(), session_.camera->info(), recordedScene(editor));
        folder_ = folder.string();
        console.notify("recording to " + folder_ + missingText(skipped));
    } catch (const std::exception& e) {
        console.switches.recording = false;
        console.notify(e.what());
    }
}

namespace {

// A message about the recording on disk.
std::string savedText(const Recorder& recorder, const std::string& folder) {
    const std::string failure = recorder.failure();
    const uint64_t lost = recorder.lost();
    if (recorder.frames() == 0) {
        return "no recording saved: " + (failure.empty() ? "no image has come" : failure);
    }
    return "saved: " + std::to_string(recorder.frames()) + " frames recorded in " + folder + ", " +
           clockText(recorder.seconds()) + ", " + byteText(recorder.bytes()) +
           (lost > 0 ? ", " + std::to_string(lost) + " skipped: the disk was too slow" : "") +
           (failure.empty() ? "" : ", then: " + failure);
}

} // namespace

void RecorderControl::reportSaved(Console& console) {
    recorder_.finish();
    console.notify(savedText(recorder_, folder_));
    folder_.clear();
}

void RecorderControl::store(Console& console) {
    try {
        KeptPast past = last_.past();
        if (past.frames.size() < 2) {
            throw Error("nothing to store yet: no image has come");
        }
        const std::filesystem::path folder = freshFolder();
        disk_.look(folder, ImGui::GetTime());
        if (const std::string problem = disk_.problem(); !problem.empty()) {
            throw Error("not stored: " + problem);
        }
        const std::string skipped = copySceneFiles(session_.scene, folder);
        past_.start(folder, past.first.text, session_.camera->info(), past.first.recorded);
        pastFolder_ = folder.string();
        pastFed_ = false;
        console.notify(printed("storing the last %.0f s to ", past.seconds()) + pastFolder_ +
                       missingText(skipped));
        storing_ = std::jthread([this, past = std::move(past)] {
            feed(past_, past);
            past_.stop();
            past_.finish();
            pastFed_ = true;
        });
    } catch (const std::exception& e) {
        console.notify(e.what());
    }
}

void RecorderControl::followStore(Console& console) {
    if (!pastFolder_.empty() && pastFed_) {
        console.notify(savedText(past_, pastFolder_));
        pastFolder_.clear();
    } else if (!pastFolder_.empty()) {
        disk_.look(pastFolder_, ImGui::GetTime());
        if (const std::string problem = disk_.problem(); !problem.empty()) {
            past_.stop(problem);
        }
    }
    if (std::exchange(console.requests.storeLast, false)) {
        if (pastFolder_.empty()) {
            store(console);
        } else {
            console.notify("the last seconds are still being stored");
        }
    }
}

void RecorderControl::follow(Console& console, FixtureEditor& editor) {
    if (console.switches.recording && folder_.empty() && !recorder_.writing()) {
        start(console, editor);
    } else if (!folder_.empty()) {
        disk_.look(folder_, ImGui::GetTime());
        if (const std::string problem = disk_.problem(); !problem.empty()) {
            recorder_.stop(problem);
        }
        if (!console.switches.recording || !recorder_.recording()) {
            recorder_.stop();
            console.switches.recording = false;
            if (!recorder_.writing()) {
                reportSaved(console);
            }
        }
    }
    followStore(console);
    console.status.keptSeconds = last_.seconds();
    console.status.recorded = {recorder_.seconds(), recorder_.bytes(), disk_.left()};
}

} // namespace fathom::operate
