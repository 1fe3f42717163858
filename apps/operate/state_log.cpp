// SPDX-License-Identifier: Apache-2.0
#include "apps/operate/state_log.h"

#include "apps/binding/scene_edits.h"
#include "apps/operate/console_state.h"
#include "apps/operate/why_panel.h"
#include "engine/gpu/instance.h"
#include "engine/types/clock.h"
#include "engine/types/error.h"
#include "engine/types/input_files.h"

#include <cmath>
#include <filesystem>
#include <imgui.h>
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

// The real arm; null without one. Joints [rad], [m] are null while they are not measured.
json armOf(const ShownArm* arm) {
    if (arm == nullptr || !arm->real) {
        return nullptr;
    }
    return {{"measured", arm->known ? json(arm->joints) : json(nullptr)},
            {"apart_m", arm->apart},
            {"worst_joint", arm->worst},
            {"error", arm->error},
            {"drawn", arm->isOff()}};
}

json runOf(const ShownState& s) {
    const RunView& run = s.view;
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
            {"contacts", r.contactCount},
            {"touches", r.touchCount},
            {"state", static_cast<int>(r.state)},
            {"guidance_w", r.guidance},
            {"frame", r.frame},
            {"scene_age_s", known(r.sceneAge)},
            {"pictures", run.scene().number},
            {"spheres", run.scene().set.spheres.size()},
            {"generation", run.scene().set.generation},
            {"grasp", r.arm.posture.grasp},
            {"arm_holds", armHolds(s.session.arm.get(), r)},
            {"arm", run.step().driven ? json(armStateName(run.step().armStatus.state)) : json(nullptr)},
            {"real_arm", armOf(s.measured)}};
}

json fixturesOf(const Scene& scene) {
    json rows = json::array();
    for (const FixtureClass& f : scene.fixtures) {
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

// Window frames: begun, drawn, skipped for passes; tiles that the CPU has drawn, and its time per frame.
json windowOf(const ShownState& s) {
    const Canvas::Counts counts = s.canvas.counts();
    const VkExtent2D size = s.window.size();
    return {
        {"begun", ImGui::GetFrameCount()},         {"frames", counts.drawn}, {"yielded", counts.yielded},
        {"swapchains", counts.swapchains},         {"width", size.width},    {"height", size.height},
        {"validation", gpu::validationMessages()}, {"tiles", counts.tiles},  {"cpu_ms", 1e3 * s.frameCost}};
}

json buttonsOf(const ButtonMap& map) {
    json bits = json::object();
    for (size_t i = 0; i < kButtonUses; ++i) {
        bits[buttonUseName(static_cast<ButtonUse>(i))] = map.chosen()[i];
    }
    return bits;
}

json handOf(const ShownState& s) {
    return s.session.liveHand
               ? json{{"name", s.session.liveHand->description()},
                      {"there", s.device.present},
                      {"held", s.device.buttonsDown},
                      {"buttons", buttonsOf(*s.device.buttons)},
                      {"mapping", s.console.editing.mapping ? json(buttonUseName(*s.console.editing.mapping))
                                                            : json(nullptr)}}
               : json(nullptr);
}

json chipsOf(const ShownState& s) {
    json words = json::array();
    for (const Chip& chip : operate::chipsOf({s.console, s.view, s.haptics})) {
        words.push_back(chip.word);
    }
    return words;
}

// Depth and distance as drawn. gap_m is null while unknown or without a region.
json cuesOf(const Screen& screen) {
    const DepthCues& cues = screen.cues();
    const auto cutBy = [&](size_t side) {
        const std::optional<CloseUp>& view = screen.closeUps()[side];
        return view ? json(view->section.size()) : json(nullptr);
    };
    return {{"gap_m", known(cues.gap)},
            {"text", gapText(cues.gap)},
            {"look", std::isfinite(cues.gap) ? json(gapName(lookOf(cues.gap))) : json(nullptr)},
            {"tether", cues.nearest ? json{vec(cues.nearest->from), vec(cues.nearest->to)} : json(nullptr)},
            {"hidden", cues.hidden},
            {"shadow", cues.shadow.size()},
            {"side", cutBy(0)}, // circles of the section
            {"top", cutBy(1)}};
}

// Force and torque as bars and traces show them; null: unknown.
json figuresOf(const ShownState& s) {
    json parts = json::array();
    for (const WrenchFigures& f : operate::figuresOf(s.view, s.haptics)) {
        parts.push_back({{"name", f.name},
                         {"delivered", f.delivered},
                         {"residual", known(f.residual)},
                         {"peak", f.peak},
                         {"ripple", known(f.ripple)},
                         {"limit", f.limit}});
    }
    return parts;
}

json alarmLinesOf(const Alarms& alarms) {
    json lines = json::array();
    for (const Alarm* alarm : alarms.shown()) {
        lines.push_back(alarm->words());
    }
    return lines;
}

json alarmsOverOf(const Alarms& alarms) {
    json lines = json::array();
    for (const EndedAlarm& ended : alarms.history()) {
        lines.push_back(ended.what);
    }
    return lines;
}

json cameraOf(const ShownState& s) {
    json streams = json::array(), controls = json::array();
    for (const CameraStream& c : s.camera->streams) {
        streams.push_back({{"name", c.name},
                           {"width", c.width},
                           {"height", c.height},
                           {"rate", c.rate},
                           {"format", c.format}});
    }
    for (const CameraControl& c : s.controlThread->answer().controls) {
        controls.push_back({{"stream", c.stream}, {"name", c.name}, {"value", c.value}, {"fixed", c.fixed}});
    }
    const FrameDelay delay = s.view.delay();
    return {{"streams", streams},
            {"controls", controls},
            {"no_controls", whyNoControls(*s.camera, *s.controlThread)},
            {"delay_s", known(delay.median)},
            {"worst_delay_s", known(delay.worst)}};
}

std::string whyOf(const ShownState& s) {
    return s.view.blocks().empty()
               ? ""
               : whyBlocked(s.view.blocks().front(), s.editor.scene(), s.view.scene().set);
}

} // namespace

StateLog::StateLog(const std::filesystem::path& file, bool appends)
    : name_(file.string()) {
    if (file.empty()) {
        return;
    }
    if (std::filesystem::is_directory(file)) {
        throw BadInput("operate", "--state", name_, "a file, a device or a pipe");
    }
    refuseInput(file);
    out_.open(file, appends ? std::ios::app : std::ios::trunc);
    if (!out_) {
        throw Error(name_ + ": cannot be written");
    }
}

void StateLog::write(const ShownState& s, bool now) {
    constexpr double kPeriod = 1.0 / 30.0; // [s]
    const double t = monotonicSeconds();
    if (!out_.is_open() || (!now && t < next_)) {
        return;
    }
    next_ = t + kPeriod;
    const Scene& scene = s.editor.scene();
    const json line = {{"console", stateOf(s.console)},
                       {"run", runOf(s)},
                       {"mode", modeOf({s.console, s.view, s.haptics}).word},
                       {"chips", chipsOf(s)},
                       {"refusal", s.console.messages.refusal},
                       {"window", windowOf(s)},
                       {"hand", handOf(s)},
                       {"gpu",
                        {{"there", s.canvas.isOpen() && !s.session.handover->notInUse()},
                         {"made_anew", s.session.cycles.renewals()}}},
                       {"depth_cues", cuesOf(s.screen)},
                       {"unknown_share", s.screen.unknownShare()},
                       {"alarms", s.alarms.inWords()},
                       {"alarm_lines", alarmLinesOf(s.alarms)},
                       {"alarms_over", alarmsOverOf(s.alarms)},
                       {"fixtures", fixturesOf(scene)},
                       {"shapes", s.editor.shapes().size()},
                       {"selected", s.editor.selectedPoints()},
                       {"why", whyOf(s)},
                       {"pilot",
                        {{"name", scene.pilot},
                         {"stiffness", s.haptics.springs.stiffness},
                         {"force_limit", s.haptics.forceLimit}}},
                       {"hovered", s.console.messages.contact},
                       {"figures", figuresOf(s)},
                       {"camera", cameraOf(s)}};
    out_ << line.dump(-1, ' ', false, json::error_handler_t::replace) << "\n" << std::flush;
    if (!out_) {
        throw Error(name_ + ": cannot be written");
    }
}

} // namespace fathom::operate
