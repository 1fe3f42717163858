// SPDX-License-Identifier: Apache-2.0
#include "apps/replay/run_watch.h"

#include "apps/binding/scene_edits.h"
#include "engine/cloud/frame_params.h"
#include "engine/cycle/haptic_notes.h"
#include "engine/cycle/step_record.h"
#include "engine/scene/dead_gates.h"
#include "engine/types/printed.h"

#include <algorithm>
#include <utility>

namespace fathom {

namespace {

constexpr int kGreySpread = 6; // largest difference of the channels of a pixel without colour, noise included
constexpr size_t kColourStep = 7;  // every 7th pixel is enough
constexpr uint32_t kBlack = 16;    // brightest channel of an image without light
constexpr uint32_t kIntervals = 5; // between frames, all of them too long

bool isBlack(std::span<const uint32_t> colour) {
    for (size_t i = 0; i < colour.size(); i += kColourStep) {
        if (std::max({colour[i] & 255, colour[i] >> 8 & 255, colour[i] >> 16 & 255}) > kBlack) {
            return false;
        }
    }
    return !colour.empty();
}

bool isGrey(std::span<const uint32_t> colour) {
    for (size_t i = 0; i < colour.size(); i += kColourStep) {
        const int r = colour[i] & 255, g = colour[i] >> 8 & 255, b = colour[i] >> 16 & 255;
        if (std::max({r, g, b}) - std::min({r, g, b}) > kGreySpread) {
            return false;
        }
    }
    return !colour.empty();
}

uint32_t at(const std::vector<uint32_t>& list, size_t c) {
    return c < list.size() ? list[c] : 0;
}

// Null if the class has none in this set.
const GuidancePose* poseOf(const HostFixtures& set, size_t row) {
    const auto found = std::ranges::find(set.guidance, row, &GuidancePose::fixture);
    return found == set.guidance.end() ? nullptr : &*found;
}

// Why the frame has no depth between near and far.
std::string depthCause(const HostFixtures& set, double nearZ, double farZ) {
    uint16_t least = UINT16_MAX, most = 0;
    for (const uint16_t d : set.depth) {
        least = d != 0 ? std::min(least, d) : least;
        most = std::max(most, d);
    }
    const std::string band = printed("no depth between camera.near %.6g and camera.far %.6g m", nearZ, farZ);
    if (most == 0) {
        return band;
    }
    const double unit = set.camera.metresPerUnit;
    return band + printed("; readings are %.6g to %.6g m", least * unit, most * unit) +
           printed(", with a depth unit of %.6g m", unit);
}

} // namespace

std::string RunWatch::causeOf(const ClassState& state, uint32_t marked, uint32_t valid,
                              const HostFixtures& set, std::span<const uint32_t> colour) const {
    const FixtureClass& f = fixtures_[state.row];
    if (valid == 0) {
        return depthCause(set, nearZ_, farZ_);
    }
    if (marked > 0 && f.role == Role::Guidance) {
        const GuidancePose* const pose = poseOf(set, state.row);
        const std::string left =
            marked >= f.minCount && pose != nullptr
                ? "; the filter" + std::string(f.largestPart ? " and largest_part leave " : " leaves ") +
                      std::to_string(pose->count) + "; min_count is "
                : ", min_count is ";
        return std::to_string(marked) + " points" + left + std::to_string(f.minCount);
    }
    if (marked > 0) {
        return "the filter rejects all its points as flying or isolated";
    }
    const bool needsColour = f.hue || (f.saturation && f.saturation->lo > 0.0);
    if (f.usesColour() && isBlack(colour)) {
        return "the colour image is black";
    }
    if (needsColour && isGrey(colour)) {
        return "the colour image is grey, and its gates need colour";
    }
    const std::string gates = f.box ? "no pixel passes its gates, box included" : "no pixel passes its gates";
    return f.usesColour() && !streams_.empty() ? gates + "; " + streams_ : gates;
}

RunWatch::RunWatch(const Scene& scene, const RunSource& source)
    : fixtures_(scene.fixtures)
    , streams_(source.streams)
    , nearZ_(scene.nearZ)
    , farZ_(scene.farZ) {
    for (const uint32_t fixture : cloud::classFixtures(scene)) {
        classes_.push_back({fixture, std::nullopt, false, ""});
    }
    for (const std::string& dead : deadGates(scene, source.camera)) {
        warnings_.add(dead, dead);
    }
    for (const std::string& line : forceWarnings(scene)) {
        warnings_.add(line, line);
    }
}

void RunWatch::setFixtures(const std::vector<FixtureClass>& fixtures) {
    for (ClassState& state : classes_) {
        const FixtureClass &before = fixtures_[state.row], &now = fixtures[state.row];
        if (before.name != now.name || before.role != now.role) { // another class, with its own patience
            state.none.reset();
        }
    }
    fixtures_ = fixtures;
}

// Pixels of forbidden classes that others of them have too, counted once more for each.
uint32_t RunWatch::sharedPixels(const cloud::FrameCounts& counts) const {
    uint32_t all = 0;
    for (size_t c = 0; c < classes_.size(); ++c) {
        all += fixtures_[classes_[c].row].role == Role::Forbidden ? at(counts.classPixels, c) : 0;
    }
    return all - std::min(all, counts.forbidden);
}

void RunWatch::frame(double t, const cloud::FrameCounts& counts, const HostFixtures& set,
                     std::span<const uint32_t> colour) {
    watchRate(t);
    rate_.framed = true;
    const uint32_t shared = sharedPixels(counts);
    for (size_t c = 0; c < classes_.size(); ++c) {
        ClassState& state = classes_[c];
        const FixtureClass& f = fixtures_[state.row];
        const uint32_t marked = at(counts.classPixels, c);
        const GuidancePose* const pose = poseOf(set, state.row);
        // A class whose pixels all belong to another one has its spheres there.
        const bool rejected = counts.spheres == 0 || (c < counts.classSpheres.size() &&
                                                      counts.classSpheres[c] == 0 && shared < marked);
        const bool some = f.role == Role::Guidance ? (pose != nullptr ? pose->present : marked >= f.minCount)
                                                   : marked > 0 && !rejected;
        if (some || isSpare(f) || f.frozen) {
            state.none.reset();
            state.cause.clear();
            state.ever = true;
            continue;
        }
        state.none = state.none.value_or(t);
        if (state.cause.empty() || t - *state.none >= kPatience) {
            state.cause = causeOf(state, marked, counts.valid, set, colour);
        }
        if (t - *state.none >= kPatience) {
            warnClass(state, printed("from %.2f s on for %.0f s", *state.none, kPatience));
        }
    }
}

void RunWatch::warnClass(const ClassState& state, const std::string& since) {
    const FixtureClass& f = fixtures_[state.row];
    warnings_.add("class " + f.name, "fixture '" + f.name + "' has no " +
                                         (f.role == Role::Guidance ? "target " : "region ") + since + ": " +
                                         state.cause);
}

void RunWatch::tick(double t, std::string_view state, int64_t frame, uint32_t vanished) {
    ++ticks_;
    last_ = t;
    if (vanished > std::exchange(vanished_, vanished)) {
        warnVanished(t);
    }
    if (state == "free" || state == "contact") {
        ++active_;
        span_.state.clear();
        return;
    }
    if (span_.state != state) {
        span_.state = state;
        span_.since = t;
    }
    span_.frame = frame;
    if (t - span_.since >= kPatience) {
        warnState(kPatience);
    }
}

std::string RunWatch::causeOfState() const {
    if (span_.state == "waiting") {
        return "the tool cannot follow the hand";
    }
    if (span_.state == "trapped") {
        return "no motion of the tool obeys all fixtures at once, so there is no force";
    }
    if (span_.state == "escape") {
        return "a placed shape or new data covers the tool, and pushes it out";
    }
    if (!rate_.framed) {
        return "no frame has become a set of regions";
    }
    if (span_.state == "fading") {
        return "the regions in use are too old: frames or contact answers are late";
    }
    return span_.frame < 0 ? "no contact answer was made near the tool"
                           : "forces are off by the dead-man switch, or the haptic device is lost";
}

void RunWatch::warnState(double seconds) {
    warnings_.add("state " + span_.state, "state '" + span_.state + "' from " +
                                              printed("%.2f s on for %.3g s: ", span_.since, seconds) +
                                              causeOfState());
}

// The tool stays where it was, and the hand feels nothing there any more.
void RunWatch::warnVanished(double t) {
    std::string cause = "the newest frame shows nothing in its place";
    for (const ClassState& state : classes_) {
        if (state.none && state.ever) {
            cause = "fixture '" + fixtures_[state.row].name + "' has no region: " + state.cause;
        }
    }
    warnings_.add("vanished", printed("a region disappeared at %.2f s while it pressed: ", t) + cause);
}

// Below 10 frames per second forces fade between two frames.
void RunWatch::watchRate(double t) {
    const double interval = t - std::exchange(rate_.frameAt, t);
    rate_.intervals += rate_.framed ? 1 : 0;
    rate_.longIntervals += rate_.framed && interval > kStaleAfter ? 1 : 0;
    if (rate_.intervals >= kIntervals && rate_.longIntervals == rate_.intervals) {
        warnings_.add("frame rate", printed("frames come %.3g s apart: forces fade %.3g s after each",
                                            interval, kStaleAfter));
    }
}

void RunWatch::end() {
    for (const ClassState& state : classes_) {
        if (state.none && !state.ever) {
            warnClass(state, "in any frame");
        }
    }
    if (ticks_ > 0 && active_ == 0) {
        warnState(last_ - span_.since);
    }
}

} // namespace fathom
