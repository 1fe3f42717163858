// SPDX-License-Identifier: Apache-2.0
#include "apps/replay/summary.h"

#include "apps/replay/tick_totals.h"

#include <cmath>
#include <nlohmann/json.hpp>

namespace fathom {

namespace {

using Json = nlohmann::ordered_json;

Json number(const std::optional<double>& value) {
    return value && std::isfinite(*value) ? Json(*value) : Json(nullptr);
}

Json vector(const std::optional<dvec3>& v) {
    return v && isFinite(*v) ? Json::array({v->x, v->y, v->z}) : Json(nullptr);
}

Json times(const Percentiles& p) {
    return {{"p50", number(p.p50)}, {"p99", number(p.p99)}, {"max", number(p.max)}};
}

Json framesJson(const ReplaySummary::Frames& frames) {
    Json json{{"count", frames.count},
              {"skipped", frames.skipped},
              {"gpu_ms", times(frames.gpuMs)},
              {"upload_ms", times(frames.uploadMs)},
              {"latency_ms", times(frames.latencyMs)},
              {"first_s", number(frames.first)}};
    if (frames.exposureMs) {
        json["exposure_to_published_ms"] = times(*frames.exposureMs);
    }
    json["answerable_ms"] = times(frames.answerableMs);
    return json;
}

Json hapticJson(const ReplaySummary::Haptic& haptic) {
    const Percentiles& tick = haptic.stepMicros;
    return {{"ticks", haptic.ticks},
            {"late", haptic.late},
            {"turn_us",
             {{"p50", number(tick.p50)},
              {"p99", number(tick.p99)},
              {"p999", number(tick.p999)},
              {"max", number(tick.max)}}},
            {"stalled_ticks", haptic.stalledTicks},
            {"trapped_ticks", haptic.trappedTicks},
            {"escape_ticks", haptic.escapeTicks},
            {"waiting_ticks", haptic.waitingTicks},
            {"regions_vanished", haptic.regionsVanished},
            {"index_shift_m", number(haptic.indexShift)},
            {"not_finite_ticks", haptic.notFiniteTicks},
            {"max_penetration_m", number(haptic.maxPenetration)},
            {"max_escape_depth_m", number(haptic.maxEscapeDepth)},
            {"max_force_N", number(haptic.maxForce)},
            {"max_torque_Nm", number(haptic.maxTorque)},
            {"max_force_step_N", number(haptic.maxForceStep)},
            {"stiffness_N_per_m", number(haptic.stiffness)},
            {"rotational_stiffness_Nm_per_rad", number(haptic.rotationalStiffness)},
            {"margin_passive_min", number(haptic.marginPassiveMin)},
            {"margin_uncoupled_min", number(haptic.marginUncoupledMin)},
            {"solver", {{"solves_mean", number(haptic.solvesMean)}, {"infeasible", haptic.infeasible}}}};
}

Json fixturesJson(const std::vector<ReplaySummary::FixtureRow>& rows) {
    Json list = Json::array();
    for (const auto& row : rows) {
        list.push_back({{"class", row.name},
                        {"role", row.role},
                        {"points_mean", number(row.pointsMean)},
                        {"spheres_mean", number(row.spheresMean)},
                        {"patches_mean", number(row.patchesMean)}});
    }
    return list;
}

Json guidanceJson(const std::vector<ReplaySummary::GuidanceRow>& rows) {
    Json list = Json::array();
    for (const auto& row : rows) {
        const bool target = row.target && isFinite(*row.target);
        const dquat q = target ? row.target->rotation : dquat(1, 0, 0, 0);
        list.push_back({{"class", row.name},
                        {"position_m", vector(row.position)},
                        {"normal", vector(row.normal)},
                        {"target_m", target ? vector(row.target->position) : Json(nullptr)},
                        {"target_qwxyz", target ? Json::array({q.w, q.x, q.y, q.z}) : Json(nullptr)},
                        {"count", row.count}});
    }
    return list;
}

Json drivenJson(const ReplaySummary::Arm::Driven& driven) {
    Json ticks = Json::object();
    for (const auto& [state, count] : driven.ticks) {
        ticks[state] = count;
    }
    return {{"arm", driven.description},
            {"last_state", driven.lastState},
            {"turns", ticks},
            {"frames_damaged", driven.damaged},
            {"reopened", driven.reopened},
            {"feedback_age_max_s", number(driven.oldest)},
            {"tip_lag_m", times(driven.tipLag)}};
}

Json armJson(const ReplaySummary::Arm& arm) {
    Json joints = Json::array(), links = Json::array();
    for (const auto& j : arm.joints) {
        joints.push_back({{"name", j.name},
                          {"lower", number(j.lower)},
                          {"upper", number(j.upper)},
                          {"speed_limit", number(j.speed)},
                          {"min", number(j.least)},
                          {"max", number(j.most)},
                          {"max_speed", number(j.fastest)}});
    }
    for (const auto& l : arm.links) {
        links.push_back(
            {{"link", l.name}, {"leaves", l.leaves}, {"max_penetration_m", number(l.penetration)}});
    }
    return {{"leaves", arm.leaves},
            {"joints", joints},
            {"links", links},
            {"limit_violation_max", number(arm.limitViolation)},
            {"residual_m", times(arm.residual)},
            {"limited_ticks", arm.limitedTicks},
            {"singular_ticks", arm.singularTicks},
            {"grasp_held_ticks", arm.graspHeldTicks},
            {"flips", arm.flips},
            {"description", arm.description}};
}

} // namespace

void ReplaySummary::Haptic::take(TickTotals totals) {
    ticks = totals.ticks;
    late = totals.late;
    stalledTicks = totals.stalled;
    trappedTicks = totals.trapped;
    escapeTicks = totals.escape;
    waitingTicks = totals.waiting;
    regionsVanished = totals.vanished;
    indexShift = totals.indexShift;
    notFiniteTicks = totals.notFinite;
    maxForce = totals.maxForce;
    maxTorque = totals.maxTorque;
    maxForceStep = totals.maxForceStep;
    marginPassiveMin = totals.minMarginPassive;
    marginUncoupledMin = totals.minMarginUncoupled;
    if (totals.ticks > 0) {
        solvesMean = static_cast<double>(totals.solves) / static_cast<double>(totals.ticks);
    }
    infeasible = totals.infeasible;
    stepMicros = percentilesOf(std::move(totals.stepMicros));
}

std::string toJson(const ReplaySummary& summary) {
    Json json = Json::object();
    json["frames"] = framesJson(summary.frames);
    json["haptic"] = hapticJson(summary.haptic);
    json["contact"] = {{"queries", summary.contact.queries},
                       {"spheres_max", summary.contact.spheresMax},
                       {"overflows", summary.contact.overflows},
                       {"query_us", times(summary.contact.queryMicros)},
                       {"where", summary.contact.where}};
    json["fixtures"] = fixturesJson(summary.fixtures);
    json["guidance"] = guidanceJson(summary.guidance);
    if (summary.arm) {
        json["arm"] = armJson(*summary.arm);
        if (summary.arm->driven) {
            json["arm"]["driven"] = drivenJson(*summary.arm->driven);
        }
    }
    json["device"] = summary.device;
    json["lockstep"] = summary.lockstep;
    json["digest"] = summary.digest;
    json["warnings"] = summary.warnings;
    // A device or class name may contain invalid UTF-8, which must not fail the summary.
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

} // namespace fathom
