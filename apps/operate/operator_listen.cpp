// SPDX-License-Identifier: Apache-2.0
// What becomes of keys and clicks: the hand, fixtures, files.
#include "apps/operate/operator_run.h"
#include "engine/types/error.h"

namespace fathom::operate {

void OperatorRun::listen() {
    const ViewPort& large = screen_.large();
    const TurnRecord& record = view_.turn().record;
    const double depth = large.view.cameraTbase.apply(record.device.position).z;
    if (steering_->step(console_, large, depth)) {
        click(ImGui::GetIO().MousePos);
    }
    hand_->setForces(console_.forces);
    feed_.freeze(console_.frozen);
    pilot_->ask(steering_->wish(console_));
    path_->press(console_.guidance ? 1u : 0u);
    followRecorder();
    if (console_.exportCsv) {
        console_.exportCsv = false;
        exportTraces();
    }
    if (console_.screenshot) {
        console_.screenshot = false;
        shotWanted_ = "screenshot-" + std::to_string(console_.shots + 1) + ".png";
    }
}

void OperatorRun::click(ImVec2 at) {
    const auto pixel = screen_.colourPixelAt(at);
    const SceneSnapshot& scene = view_.scene();
    if (!pixel || console_.spaceIsLarge) {
        return;
    }
    if (console_.pick.active) {
        editor_->pickAt(console_, scene, *pixel);
        return;
    }
    if (console_.placing == ShapeKind::None || scene.set.depth.empty()) {
        return;
    }
    const CameraInfo& camera = scene.set.camera;
    const uint32_t u = pixel->x * camera.depth.width / screen_.large().view.lens.width;
    const uint32_t v = pixel->y * camera.depth.height / screen_.large().view.lens.height;
    const uint16_t raw = scene.set.depth[static_cast<size_t>(v) * camera.depth.width + u];
    if (raw == 0) {
        console_.tell("no depth there: click on a surface");
    } else {
        const double z = raw * camera.metresPerUnit;
        const glm::dvec2 ray = camera.depth.ray(u, v);
        const dvec3 base = scene.set.baseTcamera.apply(z * dvec3(ray, 1.0));
        const dvec3 towards = scene.set.baseTcamera.rotation * dvec3(0.0, 0.0, -1.0);
        console_.tell(editor_->place(console_.placing, base, towards) ? "placed"
                                                                      : "no room: 16 shapes at most");
    }
    console_.placing = ShapeKind::None;
}

void OperatorRun::followRecorder() {
    if (console_.recording == recorder_.recording()) {
        return;
    }
    const auto folder = std::filesystem::path(options_.shots) /
                        ("recording-" + std::to_string(recordings_ + (console_.recording ? 1 : 0)));
    try {
        if (console_.recording) {
            recorder_.start(folder, editor_->text(), session_.camera->info());
            ++recordings_;
            console_.tell("recording to " + folder.string());
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

void OperatorRun::shoot(const std::string& name) {
    const auto file = std::filesystem::path(options_.shots) / name;
    try {
        painter_->screenshot(file);
        ++console_.shots;
        console_.tell("screenshot " + file.string());
    } catch (const Error& e) {
        console_.tell(e.what());
    }
}

} // namespace fathom::operate
