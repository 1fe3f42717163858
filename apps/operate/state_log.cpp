// SPDX-License-Identifier: Apache-2.0
#include "apps/operate/state_log.h"

#include "apps/binding/scene_edits.h"
#include "engine/types/error.h"

#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>

namespace fathom::operate {

namespace {

using nlohmann::json;

json vec(const dvec3& v) {
    return {v.x, v.y, v.z};
}

json known(double value) {
    return std::isfinite(value) ? json(value) : json(nullptr);
}

json consoleOf(const Console& c) {
    return {{"forces", c.forces},
            {"guidance", c.guidance},
            {"grasp", c.grasp},
            {"panels", c.panels},
            {"frozen", c.frozen},
            {"large", c.spaceIsLarge ? "space" : "camera"},
            {"paused", c.paused},
            {"recording", c.recording},
            {"tree_level", c.treeLevel},
            {"text_scale", c.textScale},
            {"tab", static_cast<int>(c.shownTab)},
            {"cursor", c.cursor ? json{c.cursor->x, c.cursor->y} : json(nullptr)},
            {"picking", c.pick.active},
            {"picked", c.pick.taken},
            {"notice", c.notice},
            {"shots", c.shots},
            {"time_line",
             {{"on", c.timeLine.on},
              {"t", c.timeLine.t},
              {"duration", c.timeLine.duration},
              {"picture", c.timeLine.image},
              {"pictures", c.timeLine.images},
              {"playing", c.timeLine.playing},
              {"speed", c.timeLine.speed},
              {"whole_memory", c.timeLine.wholeMemory}}},
            {"places", c.places}};
}

// The real arm; null without one. Joints [rad], [m] are null while they are not measured.
json armOf(const MeasuredArm* arm) {
    if (arm == nullptr || !arm->real) {
        return nullptr;
    }
    return {{"measured", arm->known ? json(arm->joints) : json(nullptr)},
            {"apart_m", arm->apart},
            {"worst_joint", arm->worst},
            {"error", arm->error},
            {"drawn", arm->isOff()}};
}

json runOf(const RunView& run, const StateExtras& extras) {
    const StepRecord& r = run.step().record;
    const Rates rates = run.rates();
    return {{"t", r.t},
            {"haptic_hz", rates.hapticHz},
            {"worst_period_ms", rates.worstPeriodMs},
            {"camera_hz", rates.cameraHz},
            {"turns", run.ticks()},
            {"device", vec(r.device.position)},
            {"tool", vec(r.tool.position)},
            {"force_N", glm::length(r.wrench.force)},
            {"torque_Nm", glm::length(r.wrench.torque)},
            {"contacts", r.contacts},
            {"touches", r.touchCount},
            {"state", static_cast<int>(r.state)},
            {"guidance_w", r.guidance},
            {"frame", r.frame},
            {"scene_age_s", known(r.sceneAge)},
            {"pictures", run.scene().number},
            {"spheres", run.scene().set.spheres.size()},
            {"generation", run.scene().set.generation},
            {"grasp", r.arm.posture.grasp},
            {"arm_holds", extras.armHolds},
            {"arm", run.step().driven ? json(armStateName(run.step().armStatus.state)) : json(nullptr)},
            {"real_arm", armOf(extras.arm)}};
}

json fixturesOf(const Scene* scene) {
    json rows = json::array();
    for (const FixtureClass& f : scene != nullptr ? scene->fixtures : std::vector<FixtureClass>()) {
        if (!isSpare(f)) {
            rows.push_back(
                {{"name", f.name},
                 {"role", f.role == Role::Forbidden ? "forbidden" : "guidance"},
                 {"radius", f.radius},
                 {"frozen", f.frozen},
                 {"shape", f.isPoints() ? json(nullptr)
                                        : json{{"at", vec(f.baseTshape.position)},
                                               {"axis", vec(f.baseTshape.rotation * dvec3(0, 0, 1))},
                                               {"size", vec(f.size)}}},
                 {"box", f.box ? json({vec(f.box->min), vec(f.box->max)}) : json(nullptr)}});
        }
    }
    return rows;
}

} // namespace

StateLog::StateLog(const std::filesystem::path& file)
    : name_(file.string()) {
    if (!file.empty()) {
        out_.open(file);
        if (!out_) {
            throw Error(name_ + ": cannot be written");
        }
    }
}

void StateLog::write(const Console& console, const RunView& run, const StateExtras& extras, bool now) {
    constexpr double kPeriod = 1.0 / 30.0; // [s]
    const double t =
        std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
    if (!out_.is_open() || (!now && t < next_)) {
        return;
    }
    next_ = t + kPeriod;
    json line = {{"console", consoleOf(console)},
                 {"run", runOf(run, extras)},
                 {"mode", extras.mode},
                 {"window",
                  {{"begun", extras.begun},
                   {"frames", extras.windowFrames},
                   {"yielded", extras.yielded},
                   {"swapchains", extras.swapchains},
                   {"width", extras.width},
                   {"height", extras.height},
                   {"validation", extras.validationMessages}}},
                 {"hand", extras.hand.empty() ? json(nullptr)
                                              : json{{"name", extras.hand}, {"there", extras.handThere}}},
                 {"gpu", {{"there", extras.deviceThere}, {"made_anew", extras.renewals}}},
                 {"unknown_share", extras.unknownShare},
                 {"alarms", extras.alarms},
                 {"fixtures", fixturesOf(extras.scene)},
                 {"shapes", extras.shapes},
                 {"selected", extras.selected},
                 {"why", extras.why},
                 {"pilot",
                  {{"name", extras.scene != nullptr ? extras.scene->pilot : ""},
                   {"stiffness", extras.stiffness},
                   {"force_limit", extras.forceLimit}}},
                 {"hovered", console.hovered}};
    out_ << line.dump(-1, ' ', false, json::error_handler_t::replace) << "\n" << std::flush;
    if (!out_) {
        throw Error(name_ + ": cannot be written");
    }
}

} // namespace fathom::operate
