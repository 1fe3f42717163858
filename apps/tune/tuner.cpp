// SPDX-License-Identifier: Apache-2.0
#include "apps/tune/tuner.h"

#include "apps/output/plot_axis.h"
#include "engine/types/clock.h"
#include "engine/types/decimation.h"
#include "engine/types/error.h"

#include <algorithm>

namespace fathom::tune {

namespace {

constexpr double kRate = 30.0;     // [Hz] of the frames
constexpr double kSeconds = 0.8;   // [s] at each place
constexpr double kHandSpeed = 1.0; // [m/s] that a contact query must allow
constexpr size_t kWarmUp = 2;      // [frames] before times count
constexpr double kLeakShare = 0.4; // of the range at which neighbours are a radius apart: slanted surfaces
constexpr size_t kPatches = 24;    // compared with the float64 twin

// The scene as measured: no arm in the image, contact queries on the CPU.
Scene measuredScene(Scene scene) {
    scene.contact.where = Scene::Contact::Where::Cpu;
    scene.arm.reset();
    scene.source.showsArm = false;
    return scene;
}

Scene withoutMemory(const Scene& written) {
    Scene scene = measuredScene(written);
    scene.filter.memory = 0;
    return scene;
}

HostFixtures trueRegions(gpu::Device& device, const TuneSource& source) {
    const auto refuse = [](const Scene& scene) {
        throw BadInput(scene.file.string(), "fixtures", "no forbidden class has points in these frames",
                       "a forbidden class that does; 'fathom replay' shows what each class selects");
    };
    // Classes of a twin always have points: whether the scene's own have is seen in the recording.
    const auto selects = [&](const SampleFrame& image) {
        return profile::regionsOf(device, withoutMemory(source.own.scene), source.own.frames.camera, image)
                   .spheres.size() > 0;
    };
    if (source.twin && std::ranges::none_of(source.own.frames.frames, selects)) {
        refuse(source.own.scene);
    }
    HostFixtures truth =
        profile::regionsOf(device, withoutMemory(source.scene), source.trueCamera, source.truth);
    if (truth.spheres.size() == 0) {
        refuse(source.scene);
    }
    return truth;
}

// The farthest region along the optical axis [m].
double farthestOf(const HostFixtures& truth, const Pose& baseTcamera) {
    const dvec3 axis = baseTcamera.rotation * dvec3(0.0, 0.0, 1.0),
                from = truth.origin - baseTcamera.position;
    double farthest = 0.0;
    for (size_t i = 0; i < truth.spheres.size(); ++i) {
        const RegionSpheres& s = truth.spheres;
        farthest = std::max(farthest, glm::dot(from + dvec3(s.x[i], s.y[i], s.z[i]), axis));
    }
    return farthest;
}

} // namespace

// A setting at work on its frames.
struct Tuner::Bench {
    Setting setting;
    const FrameSequence& frames;
    profile::FrameBench bench;
    profile::FrameSamples samples = {};
    Sets sets = {};

    Bench(gpu::Device& device, const Scene& scene, const Setting& set, const FrameSequence& sequence)
        : setting(set)
        , frames(sequence)
        , bench(device, sceneWith(measuredScene(scene), set), sequence.camera) {}

    // [ms] p50 from upload to the published set.
    double published() const { return bench.costOf(samples).total.p50; }

    void run(size_t frame, bool keep) {
        const profile::Clocks clocks;
        const FrameReport report = bench.run(frames.frames[frame]);
        if (frame >= std::min(kWarmUp, frames.frames.size() - 1)) {
            samples.add(report, clocks);
        }
        if (keep) {
            sets.push_back(bench.set().host);
        }
    }
};

std::vector<Score> TuneResult::scores() const {
    std::vector<Score> list;
    for (const TunePoint& point : points) {
        list.push_back(point.score);
    }
    return list;
}

Tuner::Tuner(gpu::Device& device, const TuneSource& source, const Tool& tool, TuneOptions options)
    : device_(device)
    , source_(source)
    , options_(std::move(options))
    , truth_(trueRegions(device, source))
    , places_(tool, truth_, source.truth.baseTcamera) {}

Tuner::~Tuner() = default;

double Tuner::elapsed() const {
    return secondsSince(began_);
}

const FrameSequence& Tuner::framesOf(uint32_t nth) {
    if (nth == 1) {
        return source_.frames;
    }
    FrameSequence& small = sizes_[nth];
    if (small.frames.empty()) {
        const CameraInfo& camera = source_.frames.camera;
        small = {source_.frames.name, decimated(camera, nth), {}};
        for (const SampleFrame& image : source_.frames.frames) {
            small.frames.push_back(decimatedImage(camera, image, nth));
        }
    }
    return small;
}

std::string Tuner::whyClosed(const TunePoint& point) const {
    const double period = 1e3 / source_.scene.haptics.rateHz; // [ms]
    const double travel = kHandSpeed * (point.felt.query.submit.p90 + period);
    if (1e3 * point.setting.reach < travel) {
        return "a hand of " + roundNumber(kHandSpeed) + " m/s moves " + profile::digits(travel) +
               " mm from one contact query to the next";
    }
    return "";
}

size_t Tuner::addPoint(const Setting& setting, const std::string& varied, const Sets& sets,
                       double published) {
    const CameraInfo& camera = framesOf(setting.decimation).camera;
    TunePoint point;
    point.setting = setting, point.varied = varied;
    point.width = camera.depth.width, point.height = camera.depth.height;
    point.published = published;
    point.felt = places_.feel(sceneWith(measuredScene(source_.scene), setting), sets, kRate, kSeconds);
    const double force = published + point.felt.query.submit.p50 + point.felt.tick.submit.p50;
    point.score = {1e3 * point.felt.error, force, point.felt.band, {}};
    point.score.why = whyClosed(point);
    result_.points.push_back(std::move(point));
    options_.progress(result_.points.size(), result_.points.back());
    return result_.points.size() - 1;
}

// Runs the settings frame by frame in turn, together with the best one so far. Their times are scaled to
// its time, so that a change of the machine's speed affects no comparison.
std::vector<size_t> Tuner::measureFrames(const std::vector<Setting>& settings, const std::string& varied) {
    if (settings.empty() || options_.stop()) {
        return {};
    }
    std::vector<std::unique_ptr<Bench>> benches;
    const auto add = [&](const Setting& setting) {
        benches.push_back(
            std::make_unique<Bench>(device_, source_.scene, setting, framesOf(setting.decimation)));
    };
    for (const Setting& setting : settings) {
        add(setting);
    }
    const bool first = result_.points.empty();
    if (!first) {
        add(result_.points[best()].setting);
    }
    for (size_t frame = 0; frame < source_.frames.frames.size(); ++frame) {
        if (options_.stop()) {
            return {};
        }
        for (size_t i = 0; i < benches.size(); ++i) {
            benches[i]->run(frame, i < settings.size());
        }
        if (frame == 0 && first) {
            verifyFirst(*benches.front());
        }
    }
    const double scale = first ? 1.0 : result_.points[best()].published / benches.back()->published();
    std::vector<size_t> added;
    for (size_t i = 0; i < settings.size(); ++i) {
        added.push_back(addPoint(settings[i], varied, benches[i]->sets, scale * benches[i]->published()));
        result_.points.back().timeScale = scale;
        sets_[added.back()] = std::move(benches[i]->sets);
    }
    return added;
}

void Tuner::verifyFirst(const Bench& bench) const {
    const std::string wrong = bench.bench.differsFromTwins(bench.frames.frames.front(), kPatches);
    profile::verify(wrong.empty(), "tune", "as written", wrong + " differs from the float64 twin");
}

std::vector<size_t> Tuner::measure(const std::vector<Setting>& settings, const std::string& varied) {
    std::vector<size_t> added;
    std::vector<Setting> others;
    for (const Setting& setting : settings) {
        const auto alike = std::find_if(sets_.begin(), sets_.end(), [&](const auto& entry) {
            return result_.points[entry.first].setting.sameRegions(setting);
        });
        if (alike == sets_.end()) {
            others.push_back(setting);
        } else if (!options_.stop()) {
            added.push_back(addPoint(setting, varied, alike->second, result_.points[alike->first].published));
        }
    }
    const std::vector<size_t> more = measureFrames(others, varied);
    added.insert(added.end(), more.begin(), more.end());
    return added;
}

// Frees the regions of all points except those that the best one needs.
void Tuner::keepBest() {
    result_.choice = choose(result_.scores(), options_.request);
    const Setting& best = result_.points[result_.choice.nearest.value_or(0)].setting;
    std::erase_if(sets_,
                  [&](const auto& entry) { return !result_.points[entry.first].setting.sameRegions(best); });
}

// Whether an image of that size has points so far apart that a tool fits between their regions.
bool Tuner::leaks(const Setting& setting) const {
    const Intrinsics lens = decimated(source_.frames.camera, setting.decimation).depth;
    double radius = HUGE_VAL;
    for (const FixtureClass& f : source_.scene.fixtures) {
        radius = f.isPoints() && f.role == Role::Forbidden ? std::min(radius, f.radius) : radius;
    }
    const double known = leaksFrom(lens, radius);
    const double from = known > 0.0 ? known : kLeakShare * radius * std::min(lens.fx, lens.fy);
    return from < farthestOf(truth_, source_.truth.baseTcamera);
}

void Tuner::vary(Vary what) {
    Trial trial;
    trial.vary = what;
    trial.skipped = options_.skip(what);
    const size_t base = best();
    if (trial.skipped.empty()) {
        std::vector<Setting> settings = othersOf(result_.points[base].setting, what);
        if (what == Vary::Size && std::erase_if(settings, [&](const Setting& s) { return leaks(s); }) > 0) {
            trial.skipped = "the regions of a smaller image may leak";
        }
        const double each = elapsed() / static_cast<double>(result_.points.size());
        const auto room = static_cast<size_t>(std::max(0.0, (options_.limit - elapsed()) / each));
        if (settings.size() > room) {
            settings.resize(room);
            trial.skipped = "the time limit of " + roundNumber(options_.limit) + " s was reached";
        }
        if (!settings.empty()) {
            trial.points = measure(settings, nameOf(what));
            if (trial.points.size() < settings.size()) {
                trial.skipped = "a signal ended the run";
            }
            if (!trial.points.empty()) {
                trial.points.insert(trial.points.begin(), base);
            }
        }
    }
    keepBest();
    trial.best = best();
    result_.trials.push_back(std::move(trial));
}

TuneResult Tuner::run() {
    measure({settingOf(source_.scene)}, "as written");
    if (result_.points.empty()) {
        return std::move(result_);
    }
    keepBest();
    for (const Vary what : kVaried) {
        vary(what);
    }
    return std::move(result_);
}

} // namespace fathom::tune
