// SPDX-License-Identifier: Apache-2.0
#include "apps/replay/replay_recorder.h"

#include "apps/output/fixtures_ply.h"
#include "apps/replay/overlay_image.h"
#include "apps/replay/traces_plot.h"
#include "engine/cloud/frame_params.h"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <numeric>
#include <sstream>
#include <string>
#include <time.h>
#include <unistd.h>
#include <utility>

namespace fathom {

namespace {

constexpr const char *kTracesFile = "traces.png", *kOverlayFile = "overlay.png",
                     *kSummaryFile = "summary.json";
constexpr double kMomentMargin = 1.05; // a rising force copies the frame once per 5 %

// [s] since the kernel started this process, to 10 ms. Empty if /proc does not say.
std::optional<double> sinceStart() {
    std::ifstream stat("/proc/self/stat");
    std::string line;
    std::getline(stat, line);
    std::istringstream rest(
        line.substr(std::min(line.size(), line.rfind(')') + 1))); // the name may hold spaces
    std::string field;
    for (int i = 3; i <= 22 && rest >> field; ++i) {
    }
    timespec now{};
    char* end = nullptr;
    const double started = std::strtod(field.c_str(), &end) / static_cast<double>(sysconf(_SC_CLK_TCK));
    if (!rest || *end != '\0' || clock_gettime(CLOCK_BOOTTIME, &now) != 0) {
        return std::nullopt;
    }
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec) - started;
}

} // namespace

ReplayRecorder::Ending::Ending(const Session& session, const HapticCycle& cycle)
    : skipped(session.camera->skipped())
    , contact(session.cycles.queryStatistics())
    , where(session.where())
    , stiffness(cycle.springs().stiffness)
    , rotationalStiffness(cycle.springs().rotationalStiffness)
    , device(session.cycles.facts().name)
    , title(session.title())
    , forceLimit(cycle.options().forceLimit)
    , torqueLimit(cycle.options().torqueLimit)
    , camera(session.cycles.camera())
    , leaves(session.tool.leaves())
    , warnings(session.camera->warnings()) {}

ReplayRecorder::ReplayRecorder(std::filesystem::path out, const Scene& scene, const RunSource& source,
                               const std::vector<std::string>& passes, bool saveFixtures, const ArmSetup* arm,
                               const std::string& realArm, const SceneEdits* edits)
    : out_(std::move(out))
    , lock_(prepareReplayFolder(out_, saveFixtures))
    , scene_(scene)
    , saveFixtures_(saveFixtures)
    , haptics_(out_ / "haptics.csv")
    , frames_(out_ / "frames.csv", passes)
    , arm_(arm)
    , armReport_(arm != nullptr ? std::make_unique<ArmReport>(out_ / "arm.csv", *arm, realArm) : nullptr)
    , watch_(scene, source)
    , edits_(edits) {
    for (const char* name : {kTracesFile, kOverlayFile, kSummaryFile}) {
        OutputFile{out_ / name}; // fails now, not after the run
    }
    takeFixtures(scene.fixtures);
}

// The edit that the set of this image was made with.
void ReplayRecorder::takeEdit(uint32_t image) {
    const SceneEdit* edit = edits_ == nullptr || edits_->empty() ? nullptr : &edits_->at(image);
    if (std::exchange(edit_, edit) != edit) {
        watch_.setFixtures(edit->scene.fixtures);
        takeFixtures(edit->scene.fixtures);
    }
}

// Edits keep the classes of points in their rows. A row that is spare now still counts for its last class.
void ReplayRecorder::takeFixtures(const std::vector<FixtureClass>& fixtures) {
    const std::vector<FixtureClass> before = std::exchange(fixtures_, fixtures);
    for (size_t i = 0; i < std::min(before.size(), fixtures_.size()); ++i) {
        if (isSpare(fixtures_[i]) && before[i].isPoints()) {
            fixtures_[i] = before[i];
        }
    }
    sums_.resize(fixtures_.size());
    for (uint32_t row = 0; row < fixtures_.size(); ++row) {
        if (fixtures_[row].isPoints() && fixtures_[row].role == Role::Guidance) {
            guidanceOf(row).name = fixtures_[row].name;
        }
    }
}

ReplaySummary::GuidanceRow& ReplayRecorder::guidanceOf(uint32_t row) {
    const auto [at, isNew] = guidance_.try_emplace(row);
    if (isNew && row < fixtures_.size()) {
        at->second.name = fixtures_[row].name;
    }
    return at->second;
}

void ReplayRecorder::frame(const FrameReport& report, double t, const HostFixtures& set,
                           std::span<const uint32_t> colour) {
    takeEdit(report.index);
    if (!report.unchanged) {
        watch_.frame(t, report.counts, set, colour);
        answerableMs_.push_back(static_cast<float>(report.answerableMs));
    }
    frames_.add(report, t);
    if (frameCount_++ == 0) {
        first_ = sinceStart();
    }
    uploadMs_.push_back(static_cast<float>(report.uploadMs));
    latencyMs_.push_back(static_cast<float>(report.latencyMs));
    gpuMs_.push_back(static_cast<float>(std::accumulate(report.passMs.begin(), report.passMs.end(), 0.0)));
    const std::vector<uint32_t> fixtures = cloud::classFixtures(scene_);
    for (size_t c = 0; c < fixtures.size() && c < report.counts.classPixels.size(); ++c) {
        sums_[fixtures[c]].points += report.counts.classPixels[c];
        sums_[fixtures[c]].spheres += report.counts.classSpheres[c];
        sums_[fixtures[c]].patches += report.counts.classPatches[c];
    }
    addGuidance(set);
    if (saveFixtures_ && !report.unchanged) {
        writeFixturesPly(out_ / fixturesFileName(set.frame), set);
    }
}

void ReplayRecorder::addGuidance(const HostFixtures& set) {
    for (const GuidancePose& pose : set.guidance) {
        if (!pose.present) {
            continue;
        }
        ReplaySummary::GuidanceRow& row = guidanceOf(pose.fixture);
        row.position = pose.position;
        row.normal = pose.planar ? std::optional(pose.normal) : std::nullopt;
        row.target = pose.target;
        row.count = pose.count;
    }
}

void ReplayRecorder::tick(const TickRow& row) {
    haptics_.add(row.record);
    watch_.tick(row.record.t, stateName(row.record.state), row.record.frame, row.record.vanished);
    totals_.add(row);
    history_.add(row.record);
    lastTick_ = row.record;
    if (armReport_) {
        armReport_->add(row);
    }
}

bool ReplayRecorder::wantsMoment() const {
    const double force = glm::length(lastTick_.wrench.force);
    return force > kMomentMargin * moment_.force ||
           (force > moment_.force && lastTick_.frame != moment_.tick.frame);
}

void ReplayRecorder::moment(const HostFixtures& set, std::span<const uint32_t> colour) {
    moment_.force = glm::length(lastTick_.wrench.force);
    moment_.tick = lastTick_;
    if (moment_.set.generation != set.generation) {
        moment_.set = set;
        moment_.colour.assign(colour.begin(), colour.end());
    }
}

std::vector<ReplaySummary::FixtureRow> ReplayRecorder::fixtureRows() const {
    std::vector<ReplaySummary::FixtureRow> rows;
    for (size_t i = 0; i < fixtures_.size(); ++i) {
        const FixtureClass& f = fixtures_[i];
        ReplaySummary::FixtureRow row;
        row.name = f.name;
        row.role = f.keepIn ? "keep_in" : (f.role == Role::Forbidden ? "forbidden" : "guidance");
        if (f.isPoints() && frameCount_ > 0) {
            const double n = static_cast<double>(frameCount_);
            row.pointsMean = sums_[i].points / n;
            row.spheresMean = sums_[i].spheres / n;
            row.patchesMean = sums_[i].patches / n;
        }
        rows.push_back(row);
    }
    return rows;
}

void ReplayRecorder::writeImages(const Ending& ending, OutputFile& tracesFile,
                                 OutputFile& overlayFile) const {
    TracesLabels labels;
    labels.subtitle = ending.title;
    labels.forceLimit = ending.forceLimit;
    labels.torqueLimit = ending.torqueLimit;
    drawTraces(history_, labels).writePng(tracesFile);

    OverlayInput overlay;
    overlay.camera = ending.camera;
    const bool strongest = moment_.force > 0.0;
    overlay.colour = strongest ? std::span<const uint32_t>(moment_.colour) : ending.colour;
    overlay.set = strongest ? &moment_.set : ending.lastSet;
    overlay.tick = strongest ? moment_.tick : lastTick_;
    if (overlay.set != nullptr) {
        overlay.baseTcamera = overlay.set->baseTcamera;
        overlay.depth = overlay.set->depth;
    }
    for (const FixtureClass& f : fixtures_) {
        overlay.classNames.push_back(f.name);
    }
    const std::vector<Sphere> links =
        arm_ != nullptr ? arm_->aboutTip(overlay.tick.arm.posture) : std::vector<Sphere>{};
    overlay.leaves = arm_ != nullptr ? std::span<const Sphere>(links) : ending.leaves;
    overlay.title = ending.title;
    drawOverlay(overlay).writePng(overlayFile);
}

ReplaySummary ReplayRecorder::finish(const Ending& ending) {
    OutputFile traces(out_ / kTracesFile), overlay(out_ / kOverlayFile), text(out_ / kSummaryFile);
    writeImages(ending, traces, overlay);
    const ReplaySummary summary = summarise(ending);
    text.write(toJson(summary));
    std::vector<OutputFile*> files{&haptics_.file(), &frames_.file(), &traces, &overlay, &text};
    std::vector<std::filesystem::path> outdated;
    if (armReport_) {
        files.insert(files.begin(), &armReport_->file());
    } else {
        outdated = outdatedArmFile(out_);
    }
    commitTogether(files, outdated);
    if (!saveFixtures_) {
        ::rmdir((out_ / "fixtures").c_str()); // of an earlier run; fails unless it is empty
    }
    return summary;
}

ReplaySummary ReplayRecorder::summarise(const Ending& ending) {
    ReplaySummary summary;
    summary.digest = haptics_.digest();
    summary.frames = {frameCount_,
                      ending.skipped,
                      first_,
                      percentilesOf(std::move(gpuMs_)),
                      percentilesOf(std::move(uploadMs_)),
                      percentilesOf(std::move(latencyMs_)),
                      ending.exposureMs,
                      percentilesOf(std::move(answerableMs_))};
    summary.haptic.take(std::move(totals_));
    summary.haptic.maxPenetration = ending.maxPenetration;
    summary.haptic.maxEscapeDepth = ending.maxEscapeDepth;
    summary.haptic.stiffness = ending.stiffness;
    summary.haptic.rotationalStiffness = ending.rotationalStiffness;
    summary.contact = {ending.contact.queries, ending.contact.spheresMax, ending.contact.overflows,
                       percentilesOf(std::move(queryMicros_)), ending.where};
    summary.fixtures = fixtureRows();
    for (const auto& [row, guidance] : guidance_) {
        summary.guidance.push_back(guidance);
    }
    if (armReport_) {
        summary.arm = armReport_->summary(ending.linkPenetration);
    }
    watch_.end();
    summary.warnings = watch_.warnings().list();
    summary.warnings.insert(summary.warnings.end(), ending.warnings.begin(), ending.warnings.end());
    if (ending.skipped > 0 && ending.warnings.empty()) {
        summary.warnings.push_back(std::to_string(ending.skipped) + " frames skipped");
    }
    summary.device = ending.device;
    summary.lockstep = ending.lockstep;
    return summary;
}

} // namespace fathom
