// SPDX-License-Identifier: Apache-2.0
// What becomes of keys and clicks: the hand, fixtures, files.
#include "apps/operate/operator_run.h"
#include "apps/operate/scene_files.h"
#include "apps/operate/view_click.h"
#include "engine/types/error.h"

namespace fathom::operate {

void OperatorRun::listen() {
    const ViewPort& large = screen_.large();
    const TurnRecord& record = view_.turn().record;
    const double depth = large.view.cameraTbase.apply(record.device.position).z;
    if (steering_->step(console_, large, depth)) {
        clickInView(console_, *editor_, screen_, view_.scene(), ImGui::GetIO().MousePos);
    }
    hand_->setForces(console_.forces);
    feed_.freeze(console_.frozen);
    pilot_->ask(steering_->wish(console_));
    path_->press(console_.guidance ? 1u : 0u);
    followRecorder();
    followPilot();
    if (console_.exportCsv) {
        console_.exportCsv = false;
        exportTraces();
    }
}

void OperatorRun::followRecorder() {
    if (console_.recording == recorder_.recording()) {
        return;
    }
    const auto folder = std::filesystem::path(options_.shots) /
                        ("recording-" + std::to_string(recordings_ + (console_.recording ? 1 : 0)));
    try {
        if (console_.recording) {
            editor_->keep(console_.settings(), session_.scene.pilot);
            const std::string left = copySceneFiles(session_.scene, folder); // before the recorder's own
            recorder_.start(folder, editor_->text(), session_.camera->info());
            ++recordings_;
            console_.tell("recording to " + folder.string() +
                          (left.empty() ? "" : ", without " + left + ": beyond the scene file's folder"));
        } else {
            recorder_.stop();
            console_.tell(std::to_string(recorder_.pictures()) + " pictures recorded in " + folder.string());
        }
    } catch (const std::exception& e) {
        console_.recording = false;
        console_.tell(e.what());
    }
}

void OperatorRun::exportTraces() {
    const auto file = std::filesystem::path(options_.shots) / "traces.csv";
    try {
        traces_.exportCsv(view_, file);
        console_.tell("traces written to " + file.string());
    } catch (const Error& e) {
        console_.tell(e.what());
    }
}

} // namespace fathom::operate
