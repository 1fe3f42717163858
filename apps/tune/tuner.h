// SPDX-License-Identifier: Apache-2.0
// Measures settings on one source and chooses among them. Varies one setting after another, each time with
// the best setting so far, which takes about twenty points instead of thousands. The best one so far is
// measured again with the others, and their times are scaled to its first one.
#pragma once

#include "apps/profile/felt_surface.h"
#include "apps/tune/tune_choice.h"
#include "apps/tune/tune_settings.h"
#include "apps/tune/tune_source.h"

#include <chrono>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace fathom::tune {

// A measured setting.
struct TunePoint {
    Setting setting;
    std::string varied;             // nameOf() what this point varies; "as written" for the first
    uint32_t width = 0, height = 0; // [pixels]
    profile::FeltSurface felt;
    double published = 0.0; // [ms] p50 from upload to the published set
    double timeScale = 1.0; // by which the measured time was multiplied: see Tuner
    Score score;
};

// One setting that was varied.
struct Trial {
    Vary vary = Vary::Window;
    std::vector<size_t> points; // the best so far first; empty = not varied
    size_t best = 0;            // the best of all points after this trial
    std::string skipped;        // why points are missing; empty = none are
};

// What to measure, and the callbacks. Every function is called by the thread of run().
struct TuneOptions {
    Request request;
    double limit = 120.0; // [s] no point is begun that would probably end later; the first always is
    // Why a setting need not be measured; empty = it must.
    std::function<std::string(Vary)> skip = [](Vary) { return std::string(); };
    std::function<void(size_t, const TunePoint&)> progress = [](size_t, const TunePoint&) {};
    // Asked between frames and between points. After the first true no further point is measured.
    std::function<bool()> stop = [] { return false; };
};

// All that was measured, and what was chosen.
struct TuneResult {
    std::vector<TunePoint> points; // the scene as written first; empty = stopped before it was measured
    std::vector<Trial> trials;
    Choice choice;

    std::vector<Score> scores() const;
};

// Device, source and tool must outlive it. For one thread, one run.
class Tuner {
public:
    // Throws BadInput when no region of the source can be touched.
    Tuner(gpu::Device& device, const TuneSource& source, const Tool& tool, TuneOptions options);
    ~Tuner();

    TuneResult run();

private:
    using Sets = std::vector<HostFixtures>;
    struct Bench;

    std::vector<size_t> measure(const std::vector<Setting>& settings, const std::string& varied);
    std::vector<size_t> measureFrames(const std::vector<Setting>& settings, const std::string& varied);
    size_t addPoint(const Setting& setting, const std::string& varied, const Sets& sets, double published);
    void verifyFirst(const Bench& bench) const; // throws Error
    void vary(Vary what);
    size_t best() const { return result_.choice.nearest.value_or(0); } // of the points so far
    void keepBest();
    bool leaks(const Setting& setting) const;
    std::string whyClosed(const TunePoint& point) const;
    const FrameSequence& framesOf(uint32_t nth);
    double elapsed() const; // [s]

    gpu::Device& device_;
    const TuneSource& source_;
    TuneOptions options_;
    HostFixtures truth_;
    profile::FeltPlaces places_;
    TuneResult result_;
    std::map<uint32_t, FrameSequence> sizes_; // of smaller images
    std::map<size_t, Sets> sets_;             // of points whose regions may be needed again
    std::chrono::steady_clock::time_point began_ = std::chrono::steady_clock::now();
};

} // namespace fathom::tune
