// SPDX-License-Identifier: Apache-2.0
// Applies the keys and clicks of a window frame: hand, fixtures, files.
#include "apps/operate/operator_run.h"
#include "apps/operate/scene_files.h"
#include "apps/operate/view_click.h"
#include "engine/types/error.h"

#include <utility>

namespace fathom::operate {

void OperatorRun::listen() {
    const ViewPort& large = screen_.large();
    const StepRecord& record = view_.step().record;
    const double depth = large.view.cameraTbase.apply(record.device.position).z;
    if (const auto at = steering_->step(console_, large, depth)) {
        clickInView(console_, *editor_, screen_, view_.scene(), *at);
    }
    if (std::exchange(forcesOff_, false)) { // overrides all other keys of this frame
        console_.forces = console_.guidance = false;
    }
    hand_->setForces(console_.forces);
    feed_.freeze(console_.frozen);
    pilot_->ask({steering_->pose(), 0});
    hand_->press(buttonsOf(console_));
    followRecorder();
    followPilot();
    if (console_.exportCsv) {
        console_.exportCsv = false;
        exportTraces();
    }
}

// Buttons that keys hold down, added to the device's own.
uint32_t OperatorRun::buttonsOf(const Console& console) const {
    const auto& arm = session_.scene.arm;
    const uint32_t grasp = arm ? arm->grasp.button : 0;
    return (console.guidance ? kGuidanceButton : 0) | (console.clutch ? session_.scene.hand.clutchBit : 0) |
           (console.grasp ? grasp : 0);
}

// The first unused folder name.
std::filesystem::path OperatorRun::freshRecording() {
    std::filesystem::path folder;
    do {
        folder = std::filesystem::path(options_.shots) / ("recording-" + std::to_string(++recordings_));
    } while (std::filesystem::exists(folder));
    return folder;
}

void OperatorRun::startRecording() {
    try {
        const std::filesystem::path folder = freshRecording();
        editor_->keep(console_.settings(), session_.scene.pilot);
        const std::string left = copySceneFiles(session_.scene, folder); // before the recorder's own
        recorder_.start(folder, editor_->text(), session_.camera->info(), recordedScene(*editor_));
        recordingTo_ = folder.string();
        console_.notify("recording to " + recordingTo_ +
                        (left.empty() ? "" : ", without " + left + ": beyond the scene file's folder"));
    } catch (const std::exception& e) {
        console_.recording = false;
        console_.notify(e.what());
    }
}

// Starts and stops recording as the console requests. After a stop, queued frames are still written while the
// window continues; a full disk stops the recording.
void OperatorRun::followRecorder() {
    const bool writing = recorder_.writing();
    if (console_.recording && recordingTo_.empty() && !writing) {
        startRecording();
    } else if (!recordingTo_.empty() && (!console_.recording || !recorder_.recording())) {
        recorder_.stop();
        console_.recording = false;
        if (recorder_.writing()) {
            return;
        }
        recorder_.finish();
        const std::string failure = recorder_.failure();
        const uint64_t lost = recorder_.lost();
        console_.notify(std::to_string(recorder_.images()) + " frames recorded in " + recordingTo_ +
                        (lost > 0 ? ", " + std::to_string(lost) + " left out: the disk was too slow" : "") +
                        (failure.empty() ? "" : ", then: " + failure));
        recordingTo_.clear();
    }
}

void OperatorRun::exportTraces() {
    const auto file = std::filesystem::path(options_.shots) / "traces.csv";
    try {
        traces_.exportCsv(view_, file);
        console_.notify("traces written to " + file.string());
    } catch (const Error& e) {
        console_.notify(e.what());
    }
}

} // namespace fathom::operate
