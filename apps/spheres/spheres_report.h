// SPDX-License-Identifier: Apache-2.0
// The output of `fathom spheres`: text about the mesh, a plot and a JSON file.
#pragma once

#include "engine/model/cover_measure.h"
#include "engine/model/mesh_file.h"

#include <filesystem>
#include <ostream>
#include <string>
#include <vector>

namespace fathom {

struct CoverRow { // one method of covering the mesh
    std::string name;
    size_t leaves = 0;
    CoverMeasure measure;
    double seconds = 0.0;
};

// Prints facts of the file and changes by cleaning, one line each; for a clean mesh only its size.
void printMesh(std::ostream& out, const LoadedMesh& loaded);
// Logs what a file states and is doubtful, ignored or applied on top of --scale.
void warnOfMesh(const std::filesystem::path& file, const LoadedMesh& loaded);
void printRows(std::ostream& out, const std::vector<CoverRow>& rows);

// Plots worst and mean protrusion over leaf count, one curve per method, on logarithmic axes.
void writeErrorPlot(const std::filesystem::path& file, const std::string& title,
                    const std::vector<CoverRow>& rows);

// Writes {"mesh": {...}, "covers": [{...}]}; lengths in m.
void writeReportJson(const std::filesystem::path& file, const LoadedMesh& loaded,
                     const std::vector<CoverRow>& rows);

// The whole file at once.
void writeSphereText(const std::filesystem::path& file, const std::string& text);

} // namespace fathom
