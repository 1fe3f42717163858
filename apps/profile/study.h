// SPDX-License-Identifier: Apache-2.0
// The results of a study: rows of error against time, their plots, and findings in words.
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

// Settings from the command line.
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

// One measured setting. Values that do not apply are NaN.
struct StudyRow {
    std::string source;  // scene or recording
    std::string setting; // short, as it labels a point
    bool isDefault = false;
    double error = std::numeric_limits<double>::quiet_NaN(); // in Study::errorUnit
    Cost cost;                                               // [ms]
    std::vector<double> more;                                // one per name in Study::moreNames
    bool onFront = false;                                    // set by markFront()
};

// Whether a default is on the Pareto front of its source.
struct Verdict {
    std::string source, setting;
    bool onFront = false;
    std::string words; // if off the front: which setting beats it, and why it stays the default
};

struct PlotPoint {
    double x = 0.0, y = 0.0;
    std::string label;
    bool isDefault = false;
    bool isFront = false;            // on the Pareto front
    double xHigh = NAN, yHigh = NAN; // upper ends of the error bars of x and y; NaN = none
};

struct PlotSeries {
    std::string name;
    std::vector<PlotPoint> points;
    bool connect = false;   // draws a line through the points in order
    double dash = 0.0;      // [pixels] dash length of the line; 0 = solid
    std::string thing = {}; // colour key, shared by all panels of a study; empty = the name
};

struct PlotPanel {
    std::string title, xLabel, yLabel; // with units
    bool logX = true, logY = true;     // values <= 0 are drawn at the low end, marked 0
    // Bars of x with labels on the left; y is not used. Bars start at 0, on a logarithmic axis at 1. With
    // signedLog the axis is logarithmic in both directions from 0 and linear near it.
    bool bars = false;
    std::vector<PlotSeries> series;
    bool signedLog = false;
    std::string ringed = "default"; // what the ring around a point with isDefault means
};

// Extracts one field of StudyRow.
using RowValue = std::function<double(const StudyRow&)>;
// p50 [ms] of a row by that clock. gpuTime uses submission to result if the device has no timestamps.
double gpuTime(const StudyRow& row);
double submitTime(const StudyRow& row);
double cpuTime(const StudyRow& row);
// p90 of the row's clock whose p50 equals `p50`, for the error bar; NaN if there is none.
double p90Of(const StudyRow& row, double p50);

// The values by which a study's rows are ranked and plotted, and the reason for its default.
struct RankingRule {
    RowValue time = submitTime;                                     // [ms]; lower is better
    RowValue error = [](const StudyRow& row) { return row.error; }; // lower is better
    std::function<std::string(const StudyRow&)> errorUnit = {};     // empty = the study's
    std::string reason = {};                                        // why the default may be off the front
};

struct Study {
    std::string name;     // of its output files
    std::string title;    // readable
    std::string labels;   // explains the settings' short names in the plot; may be empty
    std::string verified; // what was verified before timing
    std::string served;   // source of its data: recording or generated; set by the caller
    std::string errorName = "error", errorUnit = "none";
    std::string timeName; // name of the plotted time
    RankingRule rankBy;
    std::vector<std::string> moreNames;
    std::vector<StudyRow> rows;
    std::vector<PlotPanel> panels;
    std::vector<std::string> findings;
    std::vector<Verdict> verdicts; // one per default, set by markFront()
    std::string noDefault;         // why it has no default; empty if it has one
};

// Marks the Pareto front of each source by Study::rankBy. For each default, adds a verdict and a finding: on
// the front (within 5 % of time and error, the spread of repeats), beaten by which setting, or not ranked for
// lack of an error or a time.
void markFront(Study& study);

// A panel with one series per source, and the front of the shown points. x, y: values of a row; empty = the
// time and error of Study::rankBy. Skips rows without a finite y or a positive x, and sources without rows.
PlotPanel frontPanel(const Study& study, const std::string& title, const RowValue& x = {},
                     const RowValue& y = {});

// Fit of y = factor * x^exponent by least squares of the logarithms. Skips points <= 0.
struct PowerLaw {
    double exponent = 0.0, factor = 0.0;
};
std::optional<PowerLaw> fitPower(const std::vector<PlotPoint>& points);

// Throws Error that names study and setting if `holds` is false, so that wrong results are never timed.
void verify(bool holds, const std::string& study, const std::string& setting, const std::string& what);

// Formats a number with a few digits, for labels and sentences.
std::string digits(double value, int most = 3);

} // namespace fathom::profile
