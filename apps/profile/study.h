// SPDX-License-Identifier: Apache-2.0
// What a study found: rows of error against time, the images of them, and what they say in words.
#pragma once

#include "apps/profile/spread.h"
#include "engine/gpu/device.h"

#include <cmath>
#include <filesystem>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace fathom::profile {

// What the command line asked for.
struct Settings {
    std::vector<std::string> studies; // empty = all
    std::filesystem::path source;     // recording; empty = analytic scenes
    std::filesystem::path scene;      // scene file; empty = the built-in one
    std::filesystem::path out;
    bool quick = false;

    Repeats repeats() const { return quick ? Repeats{5, 12, 0.08} : Repeats{20, 200, 0.6}; }
};

struct StudyContext {
    gpu::Device& device;
    const Settings& settings;
};

// One measured setting. Values that do not apply are not a number.
struct StudyRow {
    std::string source;  // scene or recording
    std::string setting; // short: it labels a point
    bool isDefault = false;
    double error = std::numeric_limits<double>::quiet_NaN(); // in Study::errorUnit
    Cost cost;                                               // [ms]
    std::vector<double> more;                                // one a name of Study::moreNames
    bool onFront = false;                                    // set by markFront()
};

// Whether a default lies on the Pareto front of its source.
struct Verdict {
    std::string source, setting;
    bool onFront = false;
    std::string words; // off the front: which setting beats it, and why it stays the default
};

struct PlotPoint {
    double x = 0.0, y = 0.0;
    std::string label;
    bool isDefault = false;
    bool isFront = false;            // the front is drawn through these
    double xHigh = NAN, yHigh = NAN; // ends of the error bars from x and y; NaN = none
};

struct PlotSeries {
    std::string name;
    std::vector<PlotPoint> points;
    bool connect = false;   // a line through the points in their order
    double dash = 0.0;      // [pixels] of the line; 0 = solid
    std::string thing = {}; // what the colour stands for in all panels of a study; empty = the name
};

struct PlotPanel {
    std::string title, xLabel, yLabel; // with units
    bool logX = true, logY = true;     // values <= 0 stand at the low end, marked 0
    // Labels at the left, bars of x; y is not used. They start at 0, on a logarithmic axis at 1. With
    // signedLog the axis is logarithmic in both directions from 0 and linear near it.
    bool bars = false;
    std::vector<PlotSeries> series;
    bool signedLog = false;
};

// A number of a row.
using RowValue = std::function<double(const StudyRow&)>;
// p50 [ms] of one clock of a row; of the device's: from submission to result where it has no timestamps.
double gpuTime(const StudyRow& row);
double submitTime(const StudyRow& row);
double cpuTime(const StudyRow& row);
// p90 of the clock of the row whose p50 is `p50`: the end of its error bar; NaN when none is.
double p90Of(const StudyRow& row, double p50);

// What the rows of a study are ranked and plotted by, and what is said for its default.
struct RankingRule {
    RowValue time = submitTime;                                     // [ms]; lower is better
    RowValue error = [](const StudyRow& row) { return row.error; }; // lower is better
    std::function<std::string(const StudyRow&)> errorUnit = {};     // empty = the study's
    std::string reason = {};                                        // why the default may lie off the front
};

struct Study {
    std::string name;     // of its files
    std::string title;    // what it shows, for people
    std::string verified; // what was checked before anything was timed
    std::string served;   // what it measured: a recording or images made for it; set by who runs it
    std::string errorName, errorUnit;
    std::string timeName; // what the plotted time is
    RankingRule rankBy;
    std::vector<std::string> moreNames;
    std::vector<StudyRow> rows;
    std::vector<PlotPanel> panels;
    std::vector<std::string> findings;
    std::vector<Verdict> verdicts; // one a default, set by markFront()
    std::string noDefault;         // why there is none to judge; empty when there is one
};

// Marks the Pareto front of each source by the study's judgement and says of each default, as a verdict and
// as a finding, whether it lies on it (within 5 % of time and error, what repeats differ by), which setting
// beats it, or that it has no error or time to be judged by.
void markFront(Study& study);

// One panel with a series a source and the front of what it shows. x and y of a row; empty = the time
// and error that the study is judged by. Rows without a finite y or a positive x are left out, and sources
// without any row.
PlotPanel frontPanel(const Study& study, const std::string& title, const RowValue& x = {},
                     const RowValue& y = {});

// Exponent and factor of y = factor x^exponent by least squares of the logarithms; points <= 0 are left out.
struct PowerLaw {
    double exponent = 0.0, factor = 0.0;
};
std::optional<PowerLaw> fitPower(const std::vector<PlotPoint>& points);

// Throws Error that names study and setting when a result is wrong: nothing wrong is timed.
void verify(bool holds, const std::string& study, const std::string& setting, const std::string& what);

// A number with a few digits, for labels and sentences.
std::string digits(double value, int significant = 3);

} // namespace fathom::profile
