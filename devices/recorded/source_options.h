// SPDX-License-Identifier: Apache-2.0
// Options after the name of a recording: FILE,depth=TOPIC,colour=TOPIC,...
#pragma once

#include <filesystem>
#include <limits>
#include <optional>
#include <string>

namespace fathom {

// Limits of a depth unit [m]. In finer units 16 bits end below 66 mm.
inline constexpr double kFinestUnit = 1e-6, // finest
    kCoarsestUnit = 0.1,                    // coarsest: a larger step protects nothing
    kCoarsestValue = 100.0;                 // of floating-point values; some files are in units of 100 m

struct SourceOptions {
    std::string depth, colour, info;  // topics; empty = chosen; colour "none" = without colour
    std::filesystem::path intrinsics; // intrinsics.json that replaces the lenses; empty = the recording's
    std::filesystem::path extrinsics; // JSON {"t", "q_xyzw"}: depth-camera points to the colour camera
    std::optional<double> scale;      // metres per depth unit, or per unit of a cloud
    double start = 0.0;               // [s] after the first frame
    double duration = std::numeric_limits<double>::infinity(); // [s] from there
    double farthest = std::numeric_limits<double>::infinity(); // [m] of interest: the scene's far

    bool depthOnly() const { return colour == "none"; }
    // Throws BadInput when the scale is not between kFinestUnit and kCoarsestUnit, for 16-bit depth.
    void checkUnit(const std::string& file) const;
    // Throws BadInput for names of topics, which only files of messages have; colour=none is none.
    void checkNoTopics(const std::string& file) const;
    // The same as checkUnit() for depth in metres and for points: at most kCoarsestValue.
    void checkMetres(const std::string& file) const;
};

// A recording, and how to play it.
struct SourceRequest {
    std::string file;
    SourceOptions options;
};

// Splits at commas that begin one of the known keys, so that file names may have commas. Throws BadInput for
// a value that is not of its kind, and for a key given twice.
SourceRequest parseSource(const std::string& text);

} // namespace fathom
